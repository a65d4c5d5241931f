#include "lab/texel_raster.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <limits>

namespace lab {
namespace {

/// What either run of the sort draws: so many lines of the tables along a side, and texels. The
/// first sees all triangles, where a long way of one keeps its neighbours waiting.
constexpr std::array most_lines{8.0f, 64.0f};
constexpr std::array most_texels{16, 64};

/// Texels along a side of a block, as in shaders/triangle_layout.glsl.
constexpr int block_side = 8;

/// Blocks that one invocation goes over.
constexpr std::size_t most_blocks = std::size_t{1} << 14;

/// Invocations of one run over the blocks, so that each has one thing to do.
constexpr std::size_t most_invocations = std::size_t{1} << 21;

/// Texels along a side of the squares by which a map is written in the end.
constexpr int square_side = 1024;

constexpr std::size_t source_bytes = 48;
constexpr std::size_t pair_bytes = 8;

/// The list of pairs grows to so many bytes; for more pairs the sources take turns.
constexpr std::size_t most_pair_bytes = std::size_t{1} << 24;

/// Buffer bindings and texture units of the shaders.
enum binding : GLuint { on_source = 0, on_list = 1, on_second_list = 2, on_counts = 6 };
enum image_unit : GLuint { image_depths = 0, image_block_bounds = 1 };
enum unit : GLuint { unit_block_bounds = 5, unit_depths = 9 };

int blocks_along(int size) {
    return (size + block_side - 1) / block_side;
}

/// Parts into which the rows of blocks are divided, so that a part of the map has at most
/// `most_blocks` and a row more.
std::size_t strips_of(int blocks) {
    const auto side = static_cast<std::size_t>(blocks);
    return (side * side + most_blocks - 1) / most_blocks;
}

gl::buffer list_of(std::size_t count, std::size_t bytes_each) {
    return {std::max<std::size_t>(count, 1) * bytes_each, nullptr, GL_DYNAMIC_COPY};
}

} // namespace

texel_raster::texel_raster(passes& gpu)
    : gpu_(gpu), counters_(sizeof(triangle_counts), nullptr, GL_DYNAMIC_DRAW),
      sort_{gpu.compute("triangle_sort.comp"), gpu.compute("triangle_sort.comp", {"LISTED"})},
      set_up_within_(gpu.compute("triangle_setup.comp", {"TEXELS", "LISTED"})),
      set_up_crossing_(gpu.compute("triangle_setup.comp", {"TEXELS", "LISTED", "CLIPPED"})),
      bounds_(gpu.compute("block_bounds.comp")), spread_(gpu.compute("triangle_spread.comp")),
      cover_(gpu.compute("triangle_cover.comp")),
      write_(gpu.link("whole_map.vert", "map_depths.frag")) {
    const std::size_t triangles = gpu_.world().triangles.size();
    for (gl::buffer* list : {&larger_[0], &larger_[1], &crossing_}) {
        *list = list_of(triangles, sizeof(std::uint32_t));
    }
    sources_ = list_of(triangles / 4 + 1024, source_bytes);
    pairs_ = list_of(65536, pair_bytes);
}

void texel_raster::make_room_for(int size) {
    if (size == size_) {
        return;
    }
    size_ = size;
    depths_ = gl::texture(GL_R32UI, size, size);
    const auto blocks = static_cast<std::size_t>(blocks_along(size));
    block_bounds_ = gl::texture(GL_RGBA32F, blocks_along(size), blocks_along(size));
    if (pairs_.bytes() < blocks * blocks * pair_bytes) {
        pairs_ = list_of(blocks * blocks, pair_bytes);
    }
}

void texel_raster::sort(const map_resources& maps, std::size_t index) {
    make_room_for(maps.size);
    const triangle_counts none;
    counters_.write(0, sizeof none, &none);
    counters_.bind_base(GL_SHADER_STORAGE_BUFFER, on_counts);
    depths_.clear(glm::uvec4(std::bit_cast<std::uint32_t>(1.0f)));
    depths_.bind_image(image_depths, GL_READ_WRITE);
    sources_.bind_base(GL_SHADER_STORAGE_BUFFER, on_source);
    gpu_.bind_triangles();
    crossing_.bind_base(GL_SHADER_STORAGE_BUFFER, on_second_list);
    sort_into(0, index, maps.size, gpu_.world().triangles.size());
    larger_[0].bind_base(GL_SHADER_STORAGE_BUFFER, on_second_list);
    sort_into(1, index, maps.size, counts().larger[0]);
    const triangle_counts found = counts();
    set_up(set_up_within_, larger_[1], index, found.larger[1]);
    set_up(set_up_crossing_, crossing_, index, found.crossing);
    gl::wait_for_writes();
}

void texel_raster::sort_into(std::size_t list, std::size_t index, int size, std::size_t triangles) {
    if (triangles == 0) {
        return;
    }
    const gl::program& program = sort_[list];
    larger_[list].bind_base(GL_SHADER_STORAGE_BUFFER, on_list);
    program.set("map_index", static_cast<int>(index));
    program.set("triangle_count", static_cast<unsigned>(triangles));
    program.set("map_texels", static_cast<float>(size));
    program.set("list", static_cast<int>(list));
    program.set("most_lines", most_lines[list]);
    program.set("most_texels", most_texels[list]);
    program.dispatch_over(triangles);
    gl::wait_for_writes();
}

void texel_raster::set_up(const gl::program& program, const gl::buffer& list, std::size_t index,
                          std::uint32_t count) {
    if (count == 0) {
        return;
    }
    list.bind_base(GL_SHADER_STORAGE_BUFFER, on_list);
    program.set("map_index", static_cast<int>(index));
    program.set("triangle_count", count);
    program.dispatch_over(count);
}

std::size_t texel_raster::spread(std::size_t first, std::size_t count, int blocks) {
    const std::uint32_t none = 0;
    counters_.write(offsetof(triangle_counts, pairs), sizeof none, &none);
    spread_.set("first_source", static_cast<unsigned>(first));
    spread_.set("source_count", static_cast<unsigned>(count));
    spread_.set("block_columns", blocks);
    spread_.dispatch_over(count * strips_of(blocks));
    gl::wait_for_writes();
    const std::size_t pairs = counters_.read<triangle_counts>().front().pairs;
    most_pairs_ = std::max(most_pairs_, std::min(pairs, pairs_.bytes() / pair_bytes));
    return pairs;
}

void texel_raster::draw(const map_resources& maps, std::size_t index) {
    const std::size_t sources =
        std::min<std::size_t>(counts().sources, sources_.bytes() / source_bytes);
    const int blocks = blocks_along(maps.size);
    most_pairs_ = 0;
    if (sources > 0) {
        block_bounds_.bind_image(image_block_bounds, GL_WRITE_ONLY);
        bounds_.dispatch(blocks, blocks);
        gl::wait_for_writes();
        block_bounds_.bind(unit_block_bounds);
        spread_.set("map_texels", static_cast<float>(maps.size));
        spread_.set("strips", static_cast<unsigned>(strips_of(blocks)));
        cover_.set("block_columns", blocks);
    }
    // so that the count of pairs cannot pass its 32 bits either
    const std::size_t most_sources =
        std::numeric_limits<std::uint32_t>::max() /
        (static_cast<std::size_t>(blocks) * static_cast<std::size_t>(blocks));
    std::size_t share = std::min({sources, most_invocations / strips_of(blocks), most_sources});
    for (std::size_t first = 0; first < sources;) {
        share = std::min(share, sources - first);
        pairs_.bind_base(GL_SHADER_STORAGE_BUFFER, on_list);
        const std::size_t pairs = spread(first, share, blocks);
        if (pairs * pair_bytes > pairs_.bytes()) {
            if (2 * pairs_.bytes() <= most_pair_bytes) {
                pairs_ = list_of(2 * pairs_.bytes() / pair_bytes, pair_bytes);
            } else {
                share = (share + 1) / 2; // there is room for all blocks of one triangle
            }
            continue;
        }
        if (pairs > 0) {
            cover_.set("pair_count", static_cast<unsigned>(pairs));
            cover_.dispatch_over(pairs);
            gl::wait_for_writes();
        }
        first += share;
    }
    maps.targets[index].bind();
    glDepthFunc(GL_ALWAYS);
    write_.use();
    depths_.bind(unit_depths);
    nothing_.bind();
    const int squares = (maps.size + square_side - 1) / square_side;
    write_.set("squares", squares);
    glDrawArrays(GL_TRIANGLES, 0, 6 * squares * squares);
    glDepthFunc(GL_LESS);
}

triangle_counts texel_raster::counts() const {
    triangle_counts result = counters_.read<triangle_counts>().front();
    result.pairs = static_cast<std::uint32_t>(most_pairs_);
    return result;
}

bool texel_raster::grow() {
    GLint64 most = 0;
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &most);
    if (2 * sources_.bytes() > static_cast<std::size_t>(most)) {
        return false;
    }
    sources_ = gl::buffer(2 * sources_.bytes(), nullptr, GL_DYNAMIC_COPY);
    return true;
}

std::size_t texel_raster::bytes(const triangle_counts& counted) const {
    return counted.sources * source_bytes + counted.pairs * pair_bytes +
           (counted.larger[0] + counted.larger[1] + counted.crossing) * sizeof(std::uint32_t) +
           depths_.bytes() + block_bounds_.bytes();
}

} // namespace lab
