// How emitted code reaches warp tables: the default meanings of the macros WS_TABLE,
// WS_TABLE_CELLS, WS_TABLE_ROWS and WS_TABLE_NODE. This GLSL is written by hand, since host memory
// has no twin on the device; everything else is generated.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <utility>

namespace glslgen::table_access {

/// The macro names that call for this prologue begin like this.
inline constexpr std::string_view mark = "WS_TABLE";

inline constexpr std::string_view texture_head =
    "// A table is a texture: texel (k, row) holds node k of the function of that row.\n";
inline constexpr std::string_view texture_type = "#define WS_TABLE sampler2D\n";
inline constexpr std::string_view texture_type_es = "#define WS_TABLE highp sampler2D\n";
inline constexpr std::string_view texture_macros =
    R"(#define WS_TABLE_CELLS(table) (textureSize(table, 0).x - 1)
#define WS_TABLE_ROWS(table) textureSize(table, 0).y
#define WS_TABLE_NODE(table, row, k) texelFetch(table, ivec2(k, row), 0).r
)";

inline constexpr std::string_view buffer_head =
    R"(// A table is an ivec3 (first node, cells, rows) into one buffer of nodes, row after row.
)";
inline constexpr std::string_view buffer_binding =
    R"(// Define WS_TABLE_BINDING to place the buffer.
#ifndef WS_TABLE_BINDING
#define WS_TABLE_BINDING 0
#endif
)";
inline constexpr std::string_view buffer_set =
    R"(// Define WS_TABLE_SET to choose its descriptor set.
#ifndef WS_TABLE_SET
#define WS_TABLE_SET 0
#endif
)";
inline constexpr std::string_view buffer_vulkan =
    R"(layout(std430, set = WS_TABLE_SET, binding = WS_TABLE_BINDING) readonly buffer ws_table_buffer {
    float ws_table_nodes[];
};
#define WS_TABLE_FETCH(i) ws_table_nodes[i]
)";
inline constexpr std::string_view buffer_storage =
    R"(layout(std430, binding = WS_TABLE_BINDING) readonly buffer ws_table_buffer {
    float ws_table_nodes[];
};
#define WS_TABLE_FETCH(i) ws_table_nodes[i]
)";
inline constexpr std::string_view buffer_texels =
    R"(uniform samplerBuffer ws_table_nodes; // GLSL 330 has no storage buffers
#define WS_TABLE_FETCH(i) texelFetch(ws_table_nodes, i).r
)";
inline constexpr std::string_view buffer_macros = R"(#define WS_TABLE ivec3
#define WS_TABLE_CELLS(table) (table).y
#define WS_TABLE_ROWS(table) (table).z
#define WS_TABLE_NODE(table, row, k) WS_TABLE_FETCH((table).x + (row) * ((table).y + 1) + (k))
)";

inline constexpr std::string_view hook = R"(// Tables are reached through macros of yours.
#ifndef WS_TABLE
#error Define WS_TABLE before this text: the type of a table.
#endif
#ifndef WS_TABLE_CELLS
#error Define WS_TABLE_CELLS(table) before this text: the number of cells of a function.
#endif
#ifndef WS_TABLE_ROWS
#error Define WS_TABLE_ROWS(table) before this text: the number of functions.
#endif
#ifndef WS_TABLE_NODE
#error Define WS_TABLE_NODE(table, row, k) before this text: the float at node k of a function.
#endif
)";

/// All of them by name, for glsl_text.hpp.
inline constexpr std::array<std::pair<std::string_view, std::string_view>, 12> all{
    {{"texture_head", texture_head},
     {"texture_type", texture_type},
     {"texture_type_es", texture_type_es},
     {"texture_macros", texture_macros},
     {"buffer_head", buffer_head},
     {"buffer_binding", buffer_binding},
     {"buffer_set", buffer_set},
     {"buffer_vulkan", buffer_vulkan},
     {"buffer_storage", buffer_storage},
     {"buffer_texels", buffer_texels},
     {"buffer_macros", buffer_macros},
     {"hook", hook}}};

/// The prologue of committed files: the choice is made by a macro, texture by default.
inline std::string chosen_by_macro() {
    std::string text = "#ifndef WS_TABLE_ACCESS\n#define WS_TABLE_ACCESS\n";
    const auto add = [&](auto... parts) { (text.append(parts), ...); };
    add("// Define WS_TABLE_ACCESS_BUFFER, WS_TABLE_ACCESS_HOOK or nothing before this text.\n",
        "#if defined(WS_TABLE_ACCESS_HOOK)\n", hook, //
        "#elif defined(WS_TABLE_ACCESS_BUFFER)\n", buffer_head, buffer_binding,
        "#if defined(VULKAN)\n", buffer_set, buffer_vulkan,
        "#elif defined(GL_ES) || __VERSION__ >= 430\n", buffer_storage, //
        "#else\n", buffer_texels, "#endif\n", buffer_macros,            //
        "#else\n", texture_head, "#ifdef GL_ES\n", texture_type_es, "#else\n", texture_type,
        "#endif\n", texture_macros, "#endif\n#endif\n");
    return text;
}

} // namespace glslgen::table_access
