#include "lab/triangle_lists.hpp"

#include <algorithm>

namespace lab {
namespace {

constexpr std::size_t most_pieces = std::size_t{1} << 23;

/// Invocations that work on a list; each takes several pieces of a long one.
constexpr std::uint32_t most_invocations = 64 * 64;

/// As in the shaders.
enum binding : GLuint { on_counts = 6, on_ready = 7, on_waiting = 3, on_next = 5 };

bool any_of(const std::vector<triangle_counts>& counted, std::uint32_t triangle_counts::*count) {
    return std::any_of(counted.begin(), counted.end(),
                       [&](const triangle_counts& each) { return each.*count > 0; });
}

} // namespace

triangle_lists::triangle_lists(std::size_t piece_bytes)
    : piece_bytes_(piece_bytes), counters_(sizeof(triangle_counts), nullptr, GL_DYNAMIC_DRAW) {}

void triangle_lists::make_room_for(std::size_t triangles) {
    set_capacity(2 * triangles + 65536, 65536);
}

void triangle_lists::set_capacity(std::size_t ready, std::size_t waiting) {
    ready_ = gl::buffer(ready * piece_bytes_, nullptr, GL_DYNAMIC_COPY);
    for (gl::buffer& list : waiting_) {
        list = gl::buffer(waiting * piece_bytes_, nullptr, GL_DYNAMIC_COPY);
    }
}

void triangle_lists::begin() {
    const triangle_counts none;
    counters_.write(0, sizeof none, &none);
    counters_.bind_base(GL_SHADER_STORAGE_BUFFER, on_counts);
    ready_.bind_base(GL_SHADER_STORAGE_BUFFER, on_ready);
    waiting_[0].bind_base(GL_SHADER_STORAGE_BUFFER, on_waiting);
}

triangle_counts triangle_lists::counts() const {
    return counters_.read<triangle_counts>().front();
}

void triangle_lists::cut(const gl::program& cut, int rounds) {
    for (int round = 0; round < rounds; ++round) {
        const std::size_t source = static_cast<std::size_t>(round % 2);
        std::array<std::uint32_t, 2> waiting{};
        counters_.read(offsetof(triangle_counts, waiting), sizeof waiting, waiting.data());
        if (waiting[source] == 0) {
            return;
        }
        most_waiting_ = std::max(most_waiting_, waiting[source]);
        const std::uint32_t zero = 0;
        counters_.write(offsetof(triangle_counts, waiting) + (1 - source) * sizeof zero,
                        sizeof zero, &zero);
        waiting_[source].bind_base(GL_SHADER_STORAGE_BUFFER, on_waiting);
        waiting_[1 - source].bind_base(GL_SHADER_STORAGE_BUFFER, on_next);
        cut.set("list", static_cast<int>(source));
        cut.set("last_round", static_cast<int>(round + 1 == rounds));
        cut.dispatch(static_cast<int>(std::min(waiting[source], most_invocations)));
        gl::wait_for_writes();
    }
}

void triangle_lists::draw() {
    ready_.bind_base(GL_SHADER_STORAGE_BUFFER, on_ready);
    nothing_.bind();
    counters_.bind(GL_DRAW_INDIRECT_BUFFER);
    glDrawArraysIndirect(GL_TRIANGLES, nullptr);
    gl::wait_for_writes();
}

void triangle_lists::forget_counts() {
    counted_.clear();
    most_waiting_ = 0;
}

bool triangle_lists::lost_some() const {
    return any_of(counted_, &triangle_counts::lost);
}

bool triangle_lists::grow() {
    const std::size_t ready = ready_.bytes() / piece_bytes_;
    const std::size_t waiting = waiting_[0].bytes() / piece_bytes_;
    const bool lost = lost_some();
    const bool crowded = any_of(counted_, &triangle_counts::crowded);
    if ((!lost && !crowded) || ready > most_pieces || waiting > most_pieces) {
        return false;
    }
    counted_.clear();
    set_capacity(lost ? 2 * ready : ready, crowded ? 2 * waiting : waiting);
    return true;
}

std::size_t triangle_lists::bytes() const {
    std::size_t ready = 0;
    for (const triangle_counts& each : counted_) {
        ready = std::max<std::size_t>(ready, each.vertex_count / 3);
    }
    return (ready + waiting_.size() * most_waiting_) * piece_bytes_;
}

} // namespace lab
