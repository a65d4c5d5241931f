// Runs glslangValidator and spirv-val on text.
#pragma once

#include <warpshadow/glsl.hpp>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>

#include <unistd.h>

namespace shader_check {

namespace fs = std::filesystem;
namespace glsl = warpshadow::glsl;

inline std::string read(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

/// A folder of this process, removed at its end.
class scratch_folder {
  public:
    scratch_folder()
        : path_(fs::temp_directory_path() / ("warpshadow_glsl_" + std::to_string(getpid()))) {
        fs::create_directories(path_);
    }
    scratch_folder(const scratch_folder&) = delete;
    scratch_folder& operator=(const scratch_folder&) = delete;
    ~scratch_folder() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    [[nodiscard]] const fs::path& path() const { return path_; }

  private:
    fs::path path_;
};

inline const fs::path& scratch() {
    static const scratch_folder folder;
    return folder.path();
}

struct language {
    glsl::profile target;
    std::string_view name;
    std::string_view version;
};

inline constexpr std::array<language, 5> languages{
    {{glsl::profile::gl330, "330", "#version 330 core\n"},
     {glsl::profile::gl430, "430", "#version 430 core\n"},
     {glsl::profile::gl450, "450", "#version 450 core\n"},
     {glsl::profile::es310, "es310", "#version 310 es\n"},
     {glsl::profile::vulkan, "vulkan", "#version 450\n"}}};

/// Table access of the user's own: a uniform array.
inline constexpr std::string_view hook =
    "#define WS_TABLE int\n"
    "#define WS_TABLE_CELLS(table) 4\n"
    "#define WS_TABLE_ROWS(table) 4\n"
    "#define WS_TABLE_NODE(table, row, k) (float(k + row - row + table - table) / 4.0)\n";

#ifdef GLSLANG_VALIDATOR
/// The compiler's complaints about a fragment shader made of the text, or nothing.
inline std::string complaints(const language& in, std::string_view before, std::string_view text) {
    const fs::path shader = scratch() / "shader.frag";
    const fs::path log = scratch() / "log.txt";
    const fs::path binary = scratch() / "shader.spv";
    std::ofstream file(shader, std::ios::binary);
    file << in.version << before << text;
    if (in.target == glsl::profile::vulkan) {
        file << "layout(location = 0) out vec4 colour;\n";
    } else {
        file << "out highp vec4 colour;\n";
    }
    file << "void main()\n{\n    colour = vec4(0.0);\n}\n";
    file.close();
    const bool vulkan = in.target == glsl::profile::vulkan;
    // uncalled functions are kept, or there would be little to validate
    const std::string command = std::string(GLSLANG_VALIDATOR) + " --keep-uncalled " +
                                (vulkan ? "-V -o '" + binary.string() + "' " : "") + "'" +
                                shader.string() + "' >'" + log.string() + "' 2>&1";
    if (std::system(command.c_str()) != 0) {
        return read(log) + "\n";
    }
    if (vulkan) {
        const std::string check = std::string(SPIRV_VAL) + " --target-env vulkan1.0 '" +
                                  binary.string() + "' >'" + log.string() + "' 2>&1";
        if (std::system(check.c_str()) != 0) {
            return "spirv-val: " + read(log) + "\n";
        }
    }
    return "";
}
#endif

} // namespace shader_check
