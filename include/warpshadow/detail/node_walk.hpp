// The nodes of one function, one after another, without a division of integers for each.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>

namespace warpshadow::detail {

/// Gives F(k / cells) = x + (1 − ε) (before / total − x) for k = 0, 1, …, cells.
///
/// The same operations as `warp_node<double>` with 64-bit counts, hence the same bits; k · total /
/// cells is carried along as whole part and remainder.
class node_walk {
  public:
    node_walk(std::uint64_t total, int cells, double floor)
        : total_(total), cells_(static_cast<std::uint64_t>(cells)), quotient_(total / cells_),
          rest_(total - quotient_ * cells_), scale_(1.0 - floor), inverse_(double(cells)) {}

    /// Node k, from the sum of the counts before it.
    [[nodiscard]] double node(std::uint64_t before) const {
        const double x = double(k_) / inverse_;
        if (total_ == 0) {
            return x;
        }
        const double fraction = double(remainder_) / inverse_;
        const double excess =
            before >= expected_ ? double(before - expected_) : -double(expected_ - before);
        return x + scale_ * ((excess - fraction) / double(total_));
    }

    /// On to the next node.
    void advance() {
        ++k_;
        expected_ += quotient_;
        remainder_ += rest_;
        if (remainder_ >= cells_) {
            remainder_ -= cells_;
            ++expected_;
        }
    }

  private:
    std::uint64_t total_;
    std::uint64_t cells_;
    std::uint64_t quotient_;
    std::uint64_t rest_;
    double scale_;
    double inverse_; // the number of cells, to divide by
    std::uint64_t k_ = 0;
    std::uint64_t expected_ = 0;  // whole part of k · total / cells
    std::uint64_t remainder_ = 0; // and what is left of it, in cells
};

/// A node as it is stored.
template <typename Node> Node stored_node(double node) {
    if constexpr (std::is_integral_v<Node>) {
        return static_cast<Node>(std::floor(node * double(std::numeric_limits<Node>::max()) + 0.5));
    } else {
        return static_cast<Node>(node);
    }
}

/// Calls put(k, node) for k = 0 to cells with the nodes of the function of some sums.
///
/// Rounding may undo an increment that is as small as the rounding itself: the nodes never
/// decrease and never exceed 1.
template <typename Put>
void walk_nodes(std::span<const std::uint64_t> sums, std::uint64_t total, double floor, Put put) {
    const int cells = static_cast<int>(sums.size());
    node_walk walk(total, cells, floor);
    std::uint64_t before = 0;
    double previous = 0.0;
    for (int k = 0; k <= cells; ++k) {
        double node = walk.node(before);
        node = node < previous ? previous : node > 1.0 ? 1.0 : node;
        previous = node;
        put(k, node);
        if (k < cells) {
            before += sums[static_cast<std::size_t>(k)];
            walk.advance();
        }
    }
}

/// Writes the function of some sums: `sums.size()` + 1 nodes.
template <typename Node>
void write_nodes(std::span<const std::uint64_t> sums, std::uint64_t total, double floor,
                 std::span<Node> nodes) {
    walk_nodes(sums, total, floor, [nodes](int k, double node) {
        nodes[static_cast<std::size_t>(k)] = stored_node<Node>(node);
    });
}

} // namespace warpshadow::detail
