// What the lab makes of --bias, and what it measures of a bias.
#include "lab/bias.hpp"

#include "lab/measure.hpp"
#include "lab/scene.hpp"

#include <catch2/catch.hpp>

#include <limits>
#include <vector>

namespace {

/// Samples that all count but the last two: background, and one at grazing light.
lab::g_buffer_samples samples_of(std::size_t counted) {
    lab::g_buffer_samples samples;
    samples.size = {static_cast<int>(counted) + 2, 1};
    samples.position.assign(counted + 2, glm::vec4(0.0f, 0.0f, 0.0f, 1.0f));
    samples.position[counted].w = 0.0f;
    samples.n_dot_l.assign(counted + 2, 0.5f);
    samples.n_dot_l[counted + 1] = 0.05f;
    return samples;
}

} // namespace

TEST_CASE("biases are read") {
    const lab::bias_choice slope = lab::parse_bias("slope:2:4+linear");
    CHECK(slope.label == "slope:2:4+linear");
    CHECK(slope.kind == lab::bias_kind::slope);
    CHECK(slope.depth == lab::depth_kind::linear);
    CHECK(slope.value == 2.0);
    CHECK(slope.units == 4.0);
    CHECK(lab::parse_bias("back-face").kind == lab::bias_kind::none);
    CHECK(lab::parse_bias("back-face").depth == lab::depth_kind::back_faces);
    CHECK(lab::parse_bias("linear+footprint").kind == lab::bias_kind::footprint);
    CHECK(lab::parse_bias("constant").value == std::nullopt);
    CHECK(lab::parse_bias("constant:0").value == 0.0);
    CHECK(lab::parse_bias("plane").kind == lab::bias_kind::plane);
    for (const char* const text :
         {"", "+", "linear+", "constant:", "constant:1.5", "constant:1:2", "slope:1:2:3", "none:0",
          "slope:-1", "slope:inf", "plane+back-face", "linear+linear", "none+slope", "Plane"}) {
        CAPTURE(text);
        CHECK_THROWS_AS(lab::parse_bias(text), lab::bad_input);
    }
}

TEST_CASE("filters are read and written alike") {
    for (const char* const text :
         {"none", "pcf", "blur", "pcf-texels:2.5", "pcf-light:0.05", "pcf-footprint:300"}) {
        CHECK(lab::filter_name(lab::parse_filter(text)) == text);
    }
    CHECK(lab::filter_name({}) == "none");
    CHECK(lab::parse_filter("pcf-texels:2.5").radius == 2.5);
    for (const char* const text :
         {"", "gauss", "pcf:1", "blur:", "pcf-texels", "pcf-texels:", "pcf-texels:0",
          "pcf-texels:65", "pcf-light:-1", "pcf-light:nan", "pcf-light:1:2", "pcf-footprint:x"}) {
        CAPTURE(text);
        CHECK_THROWS_AS(lab::parse_filter(text), lab::bad_input);
    }
}

TEST_CASE("acne, leaks and displacement of a bias") {
    const lab::g_buffer_samples samples = samples_of(4);
    // lit and dark by its own plane; lit and dark by another surface; in shadow and lit through a
    // caster; in shadow and lit, as the texel holds no caster; background; grazing
    const std::vector<std::uint8_t> truth{0, 0, 1, 1, 0, 0};
    const std::vector<std::uint8_t> shadowed{1, 1, 0, 0, 1, 1};
    std::vector<lab::bias_sample> biases{{0.25f, 0.0f, 1.0f, 0.0f}, {0.5f, 0.0f, 2.0f, 1.0f},
                                         {0.75f, 0.0f, 3.0f, 1.0f}, {0.875f, 0.0f, 6.0f, 0.0f},
                                         {1.0f, 0.0f, 0.0f, -1.0f}, {1.0f, 0.0f, 99.0f, 0.0f}};
    const lab::bias_measures measured = lab::measure_bias(samples, truth, shadowed, biases);
    CHECK(measured.acne_ratio == 0.25);
    CHECK(measured.leak_ratio == 0.25);
    CHECK(measured.displacement_texels == 3.0);
    // the least constant that lights the one pixel of acne
    const double constant = lab::least_constant(samples, truth, biases);
    CHECK(constant >= 0.25);
    CHECK(constant <= 0.25 + 0x1p-22);

    biases[1].displacement = std::numeric_limits<float>::infinity();
    CHECK(lab::measure_bias(samples, truth, shadowed, biases).displacement_texels == std::nullopt);
    CHECK(lab::measure_bias(samples, truth, shadowed, biases).acne_ratio == 0.25);
    const lab::g_buffer_samples none = samples_of(0);
    CHECK(lab::measure_bias(none, std::vector<std::uint8_t>(2), std::vector<std::uint8_t>(2),
                            std::vector<lab::bias_sample>(2))
              .acne_ratio == std::nullopt);
}
