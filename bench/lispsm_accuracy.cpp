// Writes the accuracy table of the LiSPSM matrix: texels of error against a 100-digit oracle.
//
// lispsm_accuracy [FILE.md [FILE.json]]: Markdown to the file, or to the standard output, and the
// same numbers as JSON. Exit status 1 if an entry of the library exceeds the documented bound.
#include "arguments.hpp"
#include "lispsm_oracle.hpp"

#include <warpshadow/lispsm.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <limits>
#include <span>
#include <sstream>
#include <string>
#include <vector>

namespace {

using camera_test::real;
using lispsm_test::configuration;
using lispsm_test::oracle;
using lispsm_test::scene;

constexpr int map_size = 2048;
constexpr double documented_bound = 1e-2; // texels, float in and out

struct no_fade {
    double operator()(double) const { return 1.0; }
};

/// The recipe of Wimmer et al. 2004 in world space and float throughout, as engines have it: axes
/// from view and light, n_opt with sin γ from the dot product, P at the body, a fit by bounds.
class textbook_map {
  public:
    using vec3 = glm::vec<3, float>;

    explicit textbook_map(const scene<float>& s) : eye_(s.camera.eye) {
        const vec3 light = glm::normalize(s.direction);
        const vec3 view = s.camera.forward;
        const float cosine = glm::dot(light, view);
        const float sine = std::sqrt(1.0f - cosine * cosine);
        axis_ = glm::normalize(glm::cross(glm::cross(light, view), light));
        float z0 = std::numeric_limits<float>::max();
        float first = z0;
        float last = -z0;
        for (const vec3& p : s.body) {
            const vec3 world = eye_ + p;
            z0 = std::min(z0, glm::dot(view, world - eye_));
            first = std::min(first, glm::dot(axis_, world));
            last = std::max(last, glm::dot(axis_, world));
        }
        const float n = (z0 + std::sqrt(z0 * (z0 + (last - first) * sine))) / sine;
        start_ = first - n;
        lo_ = -1.0f / n;
        hi_ = -1.0f / (last - start_);
    }
    /// Position along the warp's axis, 0..1: it does not depend on how the map is turned.
    float along(const vec3& p) const {
        const float w = glm::dot(axis_, eye_ + p) - start_;
        return (-1.0f / w - lo_) / (hi_ - lo_);
    }

  private:
    vec3 eye_, axis_;
    float start_, lo_, hi_;
};

/// Error of the textbook along its axis, in texels, against the same formula in 100 digits.
double textbook_error(const scene<float>& s) {
    const std::vector<real> truth = lispsm_test::textbook_positions<float>(s, s.body);
    if (truth.empty()) {
        return std::numeric_limits<double>::quiet_NaN(); // the textbook has no answer
    }
    const textbook_map map(s);
    double worst = 0.0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        const double error =
            std::abs(camera_test::as_double(real(map.along(s.body[i]) - truth[i]))) * map_size;
        if (!std::isfinite(error)) {
            return error;
        }
        worst = std::max(worst, error);
    }
    return worst;
}

template <typename T, typename Fade>
double library_error(const configuration& c, bool faded, const Fade& fade) {
    const scene<T> s = lispsm_test::make_scene<T>(c);
    const oracle truth(s.camera, s.direction, std::span<const glm::vec<3, T>>(s.body), faded);
    const auto result = warpshadow::lispsm<T>(s.camera, warpshadow::sun(s.direction), s.body,
                                              warpshadow::clip::opengl, {}, fade);
    return lispsm_test::texel_error(result.matrix, truth, s, map_size);
}

std::string number(double x) {
    if (!std::isfinite(x)) {
        return "undefined";
    }
    char text[32];
    std::snprintf(text, sizeof text, "%.1e", x);
    return text;
}

} // namespace

int main(int argc, char** argv) {
    bench::expect_values(argc, argv, 2, "lispsm_accuracy [FILE.md [FILE.json]]");
    std::ostringstream markdown;
    nlohmann::json rows = nlohmann::json::array();
    double worst[4] = {0.0, 0.0, 0.0, 0.0};
    markdown << "| angle of light and view (rad) | far / near | eye from origin | float | double | "
                "float, no fade | double, no fade | textbook, float, world space |\n"
             << "|---|---|---|---|---|---|---|---|\n";
    for (const configuration& c : lispsm_test::configurations()) {
        const double errors[4] = {
            library_error<float>(c, true, warpshadow::cone_fade{}),
            library_error<double>(c, true, warpshadow::cone_fade{}),
            library_error<float>(c, false, no_fade{}),
            library_error<double>(c, false, no_fade{}),
        };
        const double textbook = textbook_error(lispsm_test::make_scene<float>(c));
        markdown << "| " << c.gamma << " | " << c.ratio << " | " << c.distance;
        for (int i = 0; i < 4; ++i) {
            markdown << " | " << number(errors[i]);
            worst[i] = errors[i] <= worst[i] ? worst[i] : errors[i];
        }
        markdown << " | " << number(textbook) << " |\n";
        nlohmann::json row = {{"gamma", c.gamma},           {"ratio", c.ratio},
                              {"distance", c.distance},     {"float", errors[0]},
                              {"double", errors[1]},        {"float_no_fade", errors[2]},
                              {"double_no_fade", errors[3]}};
        row["textbook_float_world"] =
            std::isfinite(textbook) ? nlohmann::json(textbook) : nlohmann::json(nullptr);
        rows.push_back(row);
    }
    markdown << "| **worst** | |";
    for (const double w : worst) {
        markdown << " | **" << number(w) << "**";
    }
    markdown << " | |\n";
    const nlohmann::json json = {{"schema", 1},
                                 {"map", map_size},
                                 {"unit", "texels"},
                                 {"bound", documented_bound},
                                 {"worst",
                                  {{"float", worst[0]},
                                   {"double", worst[1]},
                                   {"float_no_fade", worst[2]},
                                   {"double_no_fade", worst[3]}}},
                                 {"configurations", rows}};
    if (argc > 1) {
        std::ofstream(argv[1]) << markdown.str();
    } else {
        std::cout << markdown.str();
    }
    if (argc > 2) {
        std::ofstream(argv[2]) << json.dump(1) << '\n';
    }
    return worst[0] <= documented_bound && worst[1] <= documented_bound ? 0 : 1;
}
