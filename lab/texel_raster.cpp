#include "lab/texel_raster.hpp"

#include <algorithm>
#include <bit>

namespace lab {
namespace {

/// What either run of the sort draws: so many lines of the tables along a side, and texels. The
/// first sees all triangles, where a long way of one keeps its neighbours waiting.
constexpr std::array most_lines{8.0f, 64.0f};
constexpr std::array most_texels{16, 64};

/// Texels along a side of a block, as in shaders/triangle_layout.glsl.
constexpr int block_side = 8;

constexpr std::size_t source_bytes = 48;
constexpr std::size_t pair_bytes = 8;

/// Lists of more bytes grow no further.
constexpr std::size_t most_bytes = std::size_t{1} << 28;

/// Buffer bindings and texture units of the shaders.
enum binding : GLuint { on_source = 0, on_list = 1, on_second_list = 2, on_counts = 6 };
enum image_unit : GLuint { image_depths = 0, image_block_bounds = 1 };
enum unit : GLuint { unit_block_bounds = 5, unit_depths = 9 };

int blocks_along(int size) {
    return (size + block_side - 1) / block_side;
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
    pairs_ = list_of(triangles + 65536, pair_bytes);
}

void texel_raster::make_room_for(int size) {
    if (size == size_) {
        return;
    }
    size_ = size;
    depths_ = gl::texture(GL_R32UI, size, size);
    block_bounds_ = gl::texture(GL_RGBA32F, blocks_along(size), blocks_along(size));
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

void texel_raster::spread(const map_resources& maps) {
    const std::size_t room = sources_.bytes() / source_bytes;
    const std::size_t sources = std::min<std::size_t>(counts().sources, room);
    if (sources == 0) {
        return;
    }
    const int blocks = blocks_along(maps.size);
    block_bounds_.bind_image(image_block_bounds, GL_WRITE_ONLY);
    bounds_.dispatch(blocks, blocks);
    gl::wait_for_writes();
    block_bounds_.bind(unit_block_bounds);
    pairs_.bind_base(GL_SHADER_STORAGE_BUFFER, on_list);
    spread_.set("source_count", static_cast<unsigned>(sources));
    spread_.set("map_texels", static_cast<float>(maps.size));
    spread_.set("block_columns", blocks);
    spread_.dispatch_over(sources);
    gl::wait_for_writes();
}

void texel_raster::draw(const map_resources& maps, std::size_t index) {
    const std::size_t pairs = std::min<std::size_t>(counts().pairs, pairs_.bytes() / pair_bytes);
    if (pairs > 0) {
        cover_.set("pair_count", static_cast<unsigned>(pairs));
        cover_.set("block_columns", blocks_along(maps.size));
        cover_.dispatch_over(pairs);
        gl::wait_for_writes();
    }
    maps.targets[index].bind();
    glDepthFunc(GL_ALWAYS);
    write_.use();
    depths_.bind(unit_depths);
    nothing_.bind();
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDepthFunc(GL_LESS);
}

triangle_counts texel_raster::counts() const {
    return counters_.read<triangle_counts>().front();
}

bool texel_raster::grow() {
    if (std::max(sources_.bytes(), pairs_.bytes()) > most_bytes) {
        return false;
    }
    sources_ = gl::buffer(2 * sources_.bytes(), nullptr, GL_DYNAMIC_COPY);
    pairs_ = gl::buffer(2 * pairs_.bytes(), nullptr, GL_DYNAMIC_COPY);
    return true;
}

std::size_t texel_raster::bytes(const triangle_counts& counted) const {
    return counted.sources * source_bytes + counted.pairs * pair_bytes +
           (counted.larger[0] + counted.larger[1] + counted.crossing) * sizeof(std::uint32_t) +
           depths_.bytes() + block_bounds_.bytes();
}

} // namespace lab
