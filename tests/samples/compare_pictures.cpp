// compare_pictures GOT WANTED: whether two PNG files show the same.
//
// Tolerance: 0.2 % of the pixels may differ by more than 8 of 255 levels in a channel. Renderers
// round differently along edges, and a picture has about this share of edge pixels that can tip;
// a plain shadow map in place of the warped one changes several times as many (tested).
#define STB_IMAGE_IMPLEMENTATION
#include <stb/stb_image.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

int main(int argc, char** argv) {
    if (argc != 3) {
        std::fputs("usage: compare_pictures GOT WANTED\n", stderr);
        return 2;
    }
    int width[2] = {0, 0};
    int height[2] = {0, 0};
    const unsigned char* pixels[2] = {nullptr, nullptr};
    for (int i = 0; i < 2; ++i) {
        pixels[i] = stbi_load(argv[i + 1], &width[i], &height[i], nullptr, 3);
        if (pixels[i] == nullptr) {
            std::fprintf(stderr, "%s cannot be read\n", argv[i + 1]);
            return 2;
        }
    }
    if (width[0] != width[1] || height[0] != height[1]) {
        std::fputs("the sizes differ\n", stderr);
        return 1;
    }
    const long count = static_cast<long>(width[0]) * height[0];
    long different = 0;
    for (long i = 0; i < count; ++i) {
        int most = 0;
        for (long c = 0; c < 3; ++c) {
            most = std::max(most, std::abs(pixels[0][3 * i + c] - pixels[1][3 * i + c]));
        }
        different += most > 8 ? 1 : 0;
    }
    const double share = static_cast<double>(different) / static_cast<double>(count);
    std::printf("%.4f %% of the pixels differ by more than 8 levels\n", 100.0 * share);
    return share <= 0.002 ? 0 : 1;
}
