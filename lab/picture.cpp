#include "lab/picture.hpp"

#include "lab/scene_builder.hpp"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

namespace {

/// What stb asks for: `size` bytes at `data`, packed, in memory that it frees.
unsigned char* packed(const unsigned char* data, int size, int* packed_size, int /*quality*/) {
    uLongf length = compressBound(static_cast<uLong>(size));
    auto* const result = static_cast<unsigned char*>(std::malloc(length));
    if (result == nullptr || compress(result, &length, data, static_cast<uLong>(size)) != Z_OK) {
        std::free(result);
        return nullptr;
    }
    *packed_size = static_cast<int>(length);
    return result;
}

} // namespace

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STBI_WRITE_NO_STDIO
// zlib packs better than stb's own, in a fraction of the time
#define STBIW_ZLIB_COMPRESS packed
#include <stb/stb_image_write.h>

namespace lab {
namespace {

constexpr glm::vec3 zenith(0.18f, 0.36f, 0.72f);
constexpr glm::vec3 horizon(0.62f, 0.74f, 0.86f);

std::uint8_t srgb_byte(float linear) {
    const float c = std::clamp(linear, 0.0f, 1.0f);
    const float s = c <= 0.0031308f ? 12.92f * c : 1.055f * std::pow(c, 1.0f / 2.4f) - 0.055f;
    return static_cast<std::uint8_t>(s * 255.0f + 0.5f);
}

/// Compresses highlights; the identity in the dark.
glm::vec3 tone_mapped(glm::vec3 c) {
    const glm::vec3 x = 0.92f * c;
    return (x * (2.51f * x + 0.03f)) / (x * (2.43f * x + 0.59f) + 0.14f);
}

/// Uneven colour of natural surfaces, fixed to the place.
float patchy(glm::vec3 p, float amount) {
    if (amount <= 0.0f) {
        return 1.0f;
    }
    const float n = 0.5f * value_noise(p * 0.35f, 21u) + 0.3f * value_noise(p * 1.7f, 22u) +
                    0.35f * value_noise(p * 7.0f, 23u);
    return 1.0f + amount * n;
}

} // namespace

shader::shader(const scene& world, const ray_tracer& rays, const g_buffer_samples& samples,
               const camera_view& camera, const light_view& light)
    : size_(samples.size), dark_(samples.position.size()),
      light_(samples.position.size(), glm::vec3(0.0f)) {
    const double diagonal = glm::length(world.box.hi - world.box.lo);
    const auto reach = static_cast<float>(0.5 * std::sqrt(diagonal));
    const std::vector<std::uint32_t> seen = rays.seen_triangles(samples, camera);
    const std::vector<float> open = rays.openness(samples, reach);
    const bool sun = light.light.kind == warpshadow::light_kind::directional;

    // a lamp's light falls off with the distance; half of what it gives reaches the middle sample
    float middle = 1.0f;
    if (!sun) {
        std::vector<float> distances;
        for (std::size_t i = 0; i < samples.position.size(); ++i) {
            if (samples.position[i].w > 0.5f && samples.n_dot_l[i] > 0.0f) {
                distances.push_back(
                    glm::distance(glm::vec3(samples.position[i]), glm::vec3(light.light.position)));
            }
        }
        if (!distances.empty()) {
            const auto at = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
            std::nth_element(distances.begin(), at, distances.end());
            middle = std::max(*at, 1e-6f);
        }
    }
    const glm::vec3 sunlight = glm::vec3(1.0f, 0.93f, 0.8f) * 1.15f;
    const glm::vec3 lamplight = glm::vec3(1.0f, 0.9f, 0.76f) * 1.7f;
    const glm::vec3 eye(camera.eye);
    const auto haze = static_cast<float>(sun ? std::max(800.0, 1.4 * diagonal) : 1e30);

    for (std::size_t i = 0; i < samples.position.size(); ++i) {
        const int row = static_cast<int>(i) / size_.x;
        const float up = static_cast<float>(row) / static_cast<float>(size_.y);
        const glm::vec3 sky = glm::mix(horizon, zenith, std::clamp(1.6f * up - 0.75f, 0.0f, 1.0f));
        if (samples.position[i].w <= 0.5f) {
            dark_[i] = sun ? sky : 0.02f * sky;
            continue;
        }
        const glm::vec3 p(samples.position[i]);
        const material& paint = world.materials[world.material_of[seen[i]]];
        const glm::vec3 albedo = paint.colour * patchy(p, paint.variation);
        const float facing_up = 0.5f + 0.5f * samples.normal[i].y;
        const glm::vec3 ambient = sun ? glm::mix(glm::vec3(0.17f, 0.15f, 0.12f),
                                                 glm::vec3(0.25f, 0.32f, 0.42f), facing_up)
                                      : glm::mix(glm::vec3(0.24f, 0.22f, 0.2f),
                                                 glm::vec3(0.28f, 0.28f, 0.29f), facing_up);
        dark_[i] = albedo * ambient * (0.12f + 0.88f * open[i]);
        const float incidence = std::max(0.0f, samples.n_dot_l[i]);
        if (sun) {
            light_[i] = albedo * sunlight * incidence;
        } else {
            const float d = glm::distance(p, glm::vec3(light.light.position));
            light_[i] =
                albedo * lamplight * incidence * (middle * middle / (middle * middle + d * d));
        }
        const float clear = std::exp(-glm::distance(p, eye) / haze);
        dark_[i] = glm::mix(0.9f * horizon, dark_[i], clear);
        light_[i] *= clear;
    }
}

picture shader::shade(std::span<const std::uint8_t> shadowed) const {
    return shade_with(
        [&](std::size_t i) { return shadowed[i] != 0 ? glm::vec3(0.0f) : light_[i]; });
}

picture shader::shade(std::span<const float> light) const {
    return shade_with([&](std::size_t i) { return light[i] * light_[i]; });
}

template <typename Light> picture shader::shade_with(Light light) const {
    picture result{size_.x, size_.y, {}};
    result.rgb.resize(dark_.size() * 3);
    std::size_t out = 0;
    for (int y = size_.y - 1; y >= 0; --y) {
        for (int x = 0; x < size_.x; ++x) {
            const auto i = static_cast<std::size_t>(y * size_.x + x);
            const glm::vec3 c = tone_mapped(dark_[i] + light(i));
            for (int k = 0; k < 3; ++k) {
                result.rgb[out++] = srgb_byte(c[k]);
            }
        }
    }
    return result;
}

void paint_red(picture& target, std::span<const std::uint8_t> wrong) {
    for (int y = 0; y < target.height; ++y) {
        for (int x = 0; x < target.width; ++x) {
            const auto from = static_cast<std::size_t>((target.height - 1 - y) * target.width + x);
            if (wrong[from] != 0) {
                const auto to = static_cast<std::size_t>(y * target.width + x) * 3;
                target.rgb[to] = 236;
                target.rgb[to + 1] = 20;
                target.rgb[to + 2] = 28;
            }
        }
    }
}

picture cropped(const picture& whole, glm::ivec2 corner, glm::ivec2 size, int zoom) {
    picture result{size.x * zoom, size.y * zoom, {}};
    result.rgb.reserve(static_cast<std::size_t>(result.width * result.height) * 3);
    for (int y = 0; y < result.height; ++y) {
        for (int x = 0; x < result.width; ++x) {
            const int from_x = std::min(corner.x + x / zoom, whole.width - 1);
            const int from_y = std::min(corner.y + y / zoom, whole.height - 1);
            const auto from = static_cast<std::size_t>(from_y * whole.width + from_x) * 3;
            result.rgb.insert(result.rgb.end(),
                              {whole.rgb[from], whole.rgb[from + 1], whole.rgb[from + 2]});
        }
    }
    return result;
}

glm::ivec2 window_of_difference(std::span<const std::span<const std::uint8_t>> sets,
                                glm::ivec2 view, glm::ivec2 window) {
    const int width = view.x + 1;
    std::vector<std::vector<std::int64_t>> sums;
    for (const std::span<const std::uint8_t> marks : sets) {
        std::vector<std::int64_t> sum(static_cast<std::size_t>(width * (view.y + 1)), 0);
        for (int y = 0; y < view.y; ++y) {
            std::int64_t row = 0;
            for (int x = 0; x < view.x; ++x) {
                // row 0 of the marks is the lowest one, that of the picture the highest
                row += marks[static_cast<std::size_t>((view.y - 1 - y) * view.x + x)];
                sum[static_cast<std::size_t>((y + 1) * width + x + 1)] =
                    sum[static_cast<std::size_t>(y * width + x + 1)] + row;
            }
        }
        sums.push_back(std::move(sum));
    }
    glm::ivec2 best = (view - window) / 2;
    std::int64_t most = 0;
    const int step = std::max(1, window.x / 16);
    for (int y = 0; y + window.y <= view.y; y += step) {
        for (int x = 0; x + window.x <= view.x; x += step) {
            std::int64_t lo = std::int64_t(1) << 62;
            std::int64_t hi = 0;
            for (const std::vector<std::int64_t>& sum : sums) {
                const auto at = [&](int px, int py) {
                    return sum[static_cast<std::size_t>(py * width + px)];
                };
                const std::int64_t count = at(x + window.x, y + window.y) - at(x, y + window.y) -
                                           at(x + window.x, y) + at(x, y);
                lo = std::min(lo, count);
                hi = std::max(hi, count);
            }
            if (!sums.empty() && hi - lo > most) {
                most = hi - lo;
                best = {x, y};
            }
        }
    }
    return glm::max(best, glm::ivec2(0));
}

png_file png_of(const picture& source) {
    png_file file{source.width, source.height, {}};
    const auto append = [](void* context, void* data, int size) {
        auto* out = static_cast<std::vector<std::uint8_t>*>(context);
        const auto* first = static_cast<const std::uint8_t*>(data);
        out->insert(out->end(), first, first + size);
    };
    if (stbi_write_png_to_func(append, &file.bytes, source.width, source.height, 3,
                               source.rgb.data(), source.width * 3) == 0) {
        throw std::runtime_error("cannot encode a PNG picture");
    }
    return file;
}

} // namespace lab
