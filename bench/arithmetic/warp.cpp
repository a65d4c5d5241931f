// Warp and unwarp of a point: types, stored nodes, rows by floor, guides, points in groups.
#include "kernels.hpp"

#include <warpshadow/unwarp_guide.hpp>
#include <warpshadow/warp.hpp>
#include <warpshadow/warp_build.hpp>
#include <warpshadow/warp_points.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace ws = warpshadow;

namespace arithmetic::ARITHMETIC_BUILD {

namespace {

/// Tables of a case as a program has them.
template <typename T, typename Node> struct tables {
    explicit tables(const warp_case& from)
        : cells(from.cells), row_nodes(built(from, from.row_counts)),
          column_nodes(built(from, from.column_counts)),
          row_guide_cells(ws::guide_size(cells, cells)),
          column_guide_cells(row_guide_cells.size()) {
        ws::build_guide(rows(), {row_guide_cells, cells, cells});
        ws::build_guide(columns(), {column_guide_cells, cells, cells});
    }
    static std::vector<Node> built(const warp_case& from,
                                   const std::vector<std::uint32_t>& counts) {
        ws::build_options<T> options;
        options.floor = T(from.floor);
        options.radius = from.radius;
        const auto w = static_cast<std::size_t>(from.cells);
        std::vector<Node> nodes(w * (w + 1));
        std::vector<std::uint64_t> scratch(ws::scratch_size(from.cells, options));
        ws::build_axis<T, Node>(ws::count_view(counts, from.cells, from.cells), options, scratch,
                                {nodes, from.cells, from.cells});
        return nodes;
    }
    [[nodiscard]] ws::table_view<T, Node> rows() const { return {row_nodes, cells, cells}; }
    [[nodiscard]] ws::table_view<T, Node> columns() const { return {column_nodes, cells, cells}; }
    [[nodiscard]] ws::guide_view row_guide() const { return {row_guide_cells, cells, cells}; }
    [[nodiscard]] ws::guide_view column_guide() const { return {column_guide_cells, cells, cells}; }

    int cells;
    std::vector<Node> row_nodes, column_nodes;
    std::vector<std::uint16_t> row_guide_cells, column_guide_cells;
};

template <typename T> double texels(const glm::vec<2, T>& p, const wide2& truth) {
    return map_size * std::hypot(off(double(p.x), truth.x), off(double(p.y), truth.y));
}

/// Points one after the other.
template <typename T, typename Each>
void add_points(entries& to, const std::string& kernel, const warp_case& in,
                const std::string& variant, const std::vector<glm::vec2>& points,
                const std::vector<wide2>& truth, Each each) {
    const auto own = std::make_shared<std::vector<glm::vec<2, T>>>(points.begin(), points.end());
    add_each(
        to, kernel, in.envelope, variant, own->size(),
        [own, each](std::size_t i) { return each((*own)[i]); },
        [&truth](std::size_t i, const glm::vec<2, T>& p) { return texels(p, truth[i]); });
}

/// Points all at once.
template <typename T, typename All>
void add_batch(entries& to, const std::string& kernel, const warp_case& in,
               const std::string& variant, const std::vector<glm::vec2>& points,
               const std::vector<wide2>& truth, All all) {
    using points_of = std::vector<glm::vec<2, T>>;
    const auto from = std::make_shared<points_of>(points.begin(), points.end());
    const auto results = std::make_shared<points_of>(points.size());
    to.add({kernel, in.envelope, variant, double(points.size()),
            [from, results, all] {
                all(std::span<const glm::vec<2, T>>(*from), std::span<glm::vec<2, T>>(*results));
            },
            [results, &truth] {
                std::vector<double> errors;
                for (std::size_t i = 0; i < results->size(); ++i) {
                    errors.push_back(texels((*results)[i], truth[i]));
                }
                return errors;
            }});
}

template <typename T, typename Node>
std::shared_ptr<tables<T, Node>> add_type(entries& to, const warp_case& in,
                                          const std::string& type) {
    const auto t = std::make_shared<tables<T, Node>>(in);
    using vec2 = glm::vec<2, T>;
    add_points<T>(to, "warp", in, type, in.points, in.warped,
                  [t](const vec2& p) { return ws::warp(t->rows(), t->columns(), p); });
    add_points<T>(to, "unwarp", in, type + ", bisection", in.images, in.unwarped,
                  [t](const vec2& q) { return ws::unwarp(t->rows(), t->columns(), q); });
    add_points<T>(to, "unwarp", in, type + ", guide", in.images, in.unwarped, [t](const vec2& q) {
        return ws::unwarp(t->rows(), t->columns(), t->row_guide(), t->column_guide(), q);
    });
    return t;
}

/// Both, and what there is for many points.
template <typename T>
std::shared_ptr<tables<T, T>> add_batches(entries& to, const warp_case& in,
                                          const std::string& type) {
    const auto t = add_type<T, T>(to, in, type);
    add_batch<T>(
        to, "warp", in, type + ", `warp_points`", in.points, in.warped,
        [t](auto from, auto results) { ws::warp_points(t->rows(), t->columns(), from, results); });
    add_batch<T>(to, "unwarp", in, type + ", `unwarp_points`", in.images, in.unwarped,
                 [t](auto from, auto results) {
                     ws::unwarp_points(t->rows(), t->columns(), t->row_guide(), t->column_guide(),
                                       from, results);
                 });
    return t;
}

} // namespace

void add_warp(entries& to) {
    for (const warp_case& in : warp_cases()) {
        const auto t = add_batches<float>(to, in, "float");
        add_points<float>(
            to, "warp", in, "float, row by floor", in.points, in.warped,
            [t](const glm::vec2& p) { return ws::warp_floor(t->rows(), t->columns(), p); });
        add_points<float>(
            to, "unwarp", in, "float, row by floor", in.images, in.unwarped,
            [t](const glm::vec2& q) { return ws::unwarp_floor(t->rows(), t->columns(), q); });
        add_type<float, std::uint16_t>(to, in, "float, UNORM16 nodes");
        add_type<double, float>(to, in, "double, float nodes");
        add_batches<double>(to, in, "double");
    }
}

} // namespace arithmetic::ARITHMETIC_BUILD
