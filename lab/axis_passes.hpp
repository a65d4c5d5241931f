// Functions of one axis from the importance of a map, on the device.
#pragma once

#include "gl/objects.hpp"
#include "lab/passes.hpp"
#include "lab/warp_options.hpp"

#include <array>
#include <cstdint>

namespace lab {

/// Least density floor of functions that the device computes in float and stores.
float least_floor(int cells, table_format format);

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
    /// Programs that write tables of one format.
    struct table_programs {
        gl::program build, build_power, limit_shear, mix;
    };
    table_programs& programs(table_format format);
    void build_functions(const gl::texture& table, const warp_options& options, int cells,
                         int radius, int functions);
    const gl::texture& smooth(map_resources::tables& warp, const warp_options& options, int radius,
                              std::uint64_t most);
    void limit_shear(map_resources::tables& warp, const gl::texture& table,
                     const warp_options& options);

    passes& gpu_;
    gl::program sum_columns_, sum_boxes_;
    std::array<table_programs, 2> programs_; ///< by format
    gl::buffer mixed_;
};

} // namespace lab
