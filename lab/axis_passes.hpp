// Functions of one axis from the importance of a map, on the device.
#pragma once

#include "gl/objects.hpp"
#include "lab/passes.hpp"
#include "lab/warp_options.hpp"

#include <cstdint>

namespace lab {

/// The passes from counts to functions: smoothing across functions, the functions, shear limit.
class axis_passes {
  public:
    explicit axis_passes(passes& gpu);

    /// Functions of one axis from the counts of a map, which become their running sums.
    ///
    /// @param most what the counts may come to, all together
    void build(map_resources::tables& warp, const gl::texture& table, const warp_options& options,
               std::uint64_t most);

  private:
    void build_functions(const gl::texture& table, const warp_options& options, int cells,
                         int radius, int functions) const;
    const gl::texture& smooth(map_resources::tables& warp, const warp_options& options, int radius,
                              std::uint64_t most);
    void limit_shear(map_resources::tables& warp, const gl::texture& table,
                     const warp_options& options);

    passes& gpu_;
    gl::program sum_columns_, sum_boxes_, build_axis_, build_power_, limit_shear_, mix_;
    gl::buffer mixed_;
};

} // namespace lab
