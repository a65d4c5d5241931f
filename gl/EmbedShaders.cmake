# warpshadow_embed_shaders(<target> ROOT <folder> FUNCTION <namespace::name> [PREFIX <prefix>])
#
# Compiles every shader file below <folder> into <target> as the body of
#   std::span<const gl::shader_file> <namespace::name>();
# Names are paths from <folder>, after <prefix>. A changed, new or deleted file is noticed.

# Sets `out` to patterns for the shader files below `root`.
macro(warpshadow_shader_patterns root out)
    set(${out} *.glsl *.vert *.frag *.comp *.geom *.tesc *.tese)
    list(TRANSFORM ${out} PREPEND "${root}/")
endmacro()

if(CMAKE_SCRIPT_MODE_FILE)
    cmake_policy(VERSION 3.25)
    # Second half, run at build time: cmake -DROOT= -DPREFIX= -DFUNCTION= -DOUTPUT= -P this file.
    warpshadow_shader_patterns("${ROOT}" patterns)
    file(GLOB_RECURSE files RELATIVE "${ROOT}" ${patterns})
    list(SORT files)
    set(entries "")
    set(count 0)
    foreach(file IN LISTS files)
        file(READ "${ROOT}/${file}" text)
        string(REPLACE "\\" "\\\\" text "${text}")
        string(REPLACE "\"" "\\\"" text "${text}")
        string(REPLACE "\n" "\\n\"\n    \"" text "${text}")
        string(APPEND entries "    {\"${PREFIX}${file}\",\n    \"${text}\"},\n")
        math(EXPR count "${count} + 1")
    endforeach()
    string(REGEX MATCH "^(.*)::([^:]+)$" whole "${FUNCTION}")
    set(namespace "${CMAKE_MATCH_1}")
    set(name "${CMAKE_MATCH_2}")
    if(count EQUAL 0)
        set(body "    return {};")
    else()
        set(body "    return files;")
        set(entries "const std::array<gl::shader_file, ${count}> files{{\n${entries}}};\n")
    endif()
    file(WRITE "${OUTPUT}"
"// Written by gl/EmbedShaders.cmake.
// Compilers take longer strings than the standard asks for.
#pragma GCC diagnostic ignored \"-Woverlength-strings\"
#include \"gl/shader_source.hpp\"

#include <array>

namespace {
${entries}} // namespace

namespace ${namespace} {
std::span<const gl::shader_file> ${name}() {
${body}
}
} // namespace ${namespace}
")
    return()
endif()

set(WARPSHADOW_EMBED_SHADERS_SCRIPT "${CMAKE_CURRENT_LIST_FILE}" CACHE INTERNAL "")

function(warpshadow_embed_shaders target)
    cmake_parse_arguments(PARSE_ARGV 1 arg "" "ROOT;FUNCTION;PREFIX" "")
    get_filename_component(root "${arg_ROOT}" ABSOLUTE)
    warpshadow_shader_patterns("${root}" patterns)
    file(GLOB_RECURSE files CONFIGURE_DEPENDS ${patterns})
    string(SHA1 names "${files}") # a deleted file changes the command and so runs it again
    string(MAKE_C_IDENTIFIER "${arg_FUNCTION}" identifier)
    set(output "${CMAKE_CURRENT_BINARY_DIR}/embedded_${identifier}.cpp")
    add_custom_command(
        OUTPUT "${output}"
        COMMAND "${CMAKE_COMMAND}" "-DROOT=${root}" "-DPREFIX=${arg_PREFIX}"
            "-DFUNCTION=${arg_FUNCTION}" "-DOUTPUT=${output}"
            "-DNAMES=${names}" -P "${WARPSHADOW_EMBED_SHADERS_SCRIPT}"
        DEPENDS ${files} "${WARPSHADOW_EMBED_SHADERS_SCRIPT}"
        COMMENT "Embedding shaders of ${arg_ROOT}"
        VERBATIM)
    target_sources(${target} PRIVATE "${output}")
endfunction()
