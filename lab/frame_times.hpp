// How long frames take, as a whole and pass by pass.
#pragma once

#include "lab/methods.hpp"
#include "lab/passes.hpp"
#include "lab/statistics.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <vector>

namespace lab {

/// Runs a frame `repeat` times as a whole and returns what each took.
/// @param frame draws it
template <typename Frame> std::vector<double> time_frames(passes& gpu, int repeat, Frame frame) {
    std::vector<double> frames;
    for (int i = 0; i < repeat; ++i) {
        gpu.watch().start();
        frame();
        frames.push_back(gpu.watch().stop());
    }
    return frames;
}

/// The same for a result, then a few times pass by pass if that is asked for.
template <typename Frame>
void time_frames(passes& gpu, int repeat, Frame frame, method_result& result, bool pass_by_pass) {
    add_times(result, time_frames(gpu, repeat, frame));
    if (!pass_by_pass) {
        return;
    }
    std::map<std::string, std::vector<double>> times;
    gpu.time_into(&times);
    for (int i = 0; i < std::min(repeat, 3); ++i) {
        frame();
        gpu.begin_frame();
    }
    gpu.time_into(nullptr);
    for (const std::string& pass : gpu.timed()) {
        result.passes.push_back({pass, median(times[pass])});
    }
}

/// Runs a frame once, pass by pass.
/// @return milliseconds of the passes between the G-buffer and the shadow test
template <typename Frame> double time_shadow_passes(passes& gpu, Frame frame) {
    std::map<std::string, std::vector<double>> times;
    gpu.time_into(&times);
    frame();
    gpu.begin_frame();
    gpu.time_into(nullptr);
    double sum = 0.0;
    for (const auto& [pass, ms] : times) {
        if (pass != "g-buffer" && pass != "shadow test") {
            sum += median(ms);
        }
    }
    return sum;
}

} // namespace lab
