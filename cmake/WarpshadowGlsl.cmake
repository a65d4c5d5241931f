# warpshadow_glsl: writes GLSL at build time, out of date only when its inputs are.
#
#   warpshadow_glsl(<target> OUTPUT <file> FUNCTIONS <name>...
#       [PREFIX <prefix>] [PROFILE 330|430|450|es310|vulkan] [TABLES texture|buffer|hook]
#       [PRECISION none|lowp|mediump|highp] [PRECISE] [STRIP_COMMENTS])
#
# writes functions of the library and what they need; FUNCTIONS all for everything.
#
#   warpshadow_glsl(<target> OUTPUT <file> HEADER <header or list of instantiations>
#       [PREFIX <prefix>] [FLAGS <flag of the compiler>...])
#
# translates functions of your own (tools/glslgen, which needs the LLVM headers; set
# WARPSHADOW_BUILD_GENERATOR). A change of any header that was read runs it again.
#
# The file becomes a source of <target> and so is built before it. A relative OUTPUT is taken from
# the current binary directory.
include_guard(GLOBAL)

# Either the target of this build or a program that is installed.
function(_warpshadow_glsl_program variable name)
    if(TARGET ${name})
        set(${variable} "$<TARGET_FILE:${name}>" PARENT_SCOPE)
        set(${variable}_DEPENDS ${name} PARENT_SCOPE)
        return()
    endif()
    string(MAKE_C_IDENTIFIER "WARPSHADOW_PROGRAM_${name}" cached)
    find_program(${cached} ${name} HINTS "${PACKAGE_PREFIX_DIR}/bin" "${warpshadow_DIR}/../../../bin")
    mark_as_advanced(${cached})
    if(NOT ${cached})
        message(FATAL_ERROR "warpshadow_glsl: ${name} is neither built here nor installed")
    endif()
    set(${variable} "${${cached}}" PARENT_SCOPE)
    set(${variable}_DEPENDS "${${cached}}" PARENT_SCOPE)
endfunction()

function(warpshadow_glsl target)
    cmake_parse_arguments(PARSE_ARGV 1 arg "PRECISE;STRIP_COMMENTS"
        "OUTPUT;PREFIX;PROFILE;TABLES;PRECISION;HEADER" "FUNCTIONS;FLAGS")
    if(arg_UNPARSED_ARGUMENTS)
        message(FATAL_ERROR "warpshadow_glsl: unknown arguments: ${arg_UNPARSED_ARGUMENTS}")
    endif()
    if(NOT arg_OUTPUT)
        message(FATAL_ERROR "warpshadow_glsl: OUTPUT is missing")
    endif()
    if((arg_FUNCTIONS AND arg_HEADER) OR (NOT arg_FUNCTIONS AND NOT arg_HEADER))
        message(FATAL_ERROR "warpshadow_glsl: give either FUNCTIONS or HEADER")
    endif()
    get_filename_component(output "${arg_OUTPUT}" ABSOLUTE BASE_DIR "${CMAKE_CURRENT_BINARY_DIR}")
    get_filename_component(folder "${output}" DIRECTORY)
    file(MAKE_DIRECTORY "${folder}")

    set(options "")
    if(arg_PREFIX)
        list(APPEND options --prefix "${arg_PREFIX}")
    endif()
    if(arg_FUNCTIONS)
        if(arg_FLAGS)
            message(FATAL_ERROR "warpshadow_glsl: FLAGS go with HEADER")
        endif()
        _warpshadow_glsl_program(program warpshadow-glsl)
        foreach(option PROFILE TABLES PRECISION)
            if(arg_${option})
                string(TOLOWER "${option}" name)
                list(APPEND options --${name} "${arg_${option}}")
            endif()
        endforeach()
        if(arg_PRECISE)
            list(APPEND options --precise)
        endif()
        if(arg_STRIP_COMMENTS)
            list(APPEND options --strip-comments)
        endif()
        add_custom_command(
            OUTPUT "${output}"
            COMMAND "${program}" emit ${arg_FUNCTIONS} ${options} -o "${output}"
            DEPENDS ${program_DEPENDS}
            COMMENT "Writing ${arg_OUTPUT}"
            VERBATIM)
    else()
        foreach(option PROFILE TABLES PRECISION PRECISE STRIP_COMMENTS)
            if(arg_${option})
                message(FATAL_ERROR "warpshadow_glsl: ${option} goes with FUNCTIONS; the GLSL of a "
                                    "HEADER serves every profile")
            endif()
        endforeach()
        _warpshadow_glsl_program(program warpshadow-glslgen)
        get_filename_component(header "${arg_HEADER}" ABSOLUTE BASE_DIR "${CMAKE_CURRENT_SOURCE_DIR}")
        add_custom_command(
            OUTPUT "${output}"
            COMMAND "${program}" "${header}" -o "${output}" --depfile "${output}.d" ${options}
                    -- ${arg_FLAGS}
            DEPENDS ${program_DEPENDS} "${header}"
            DEPFILE "${output}.d"
            COMMENT "Translating ${arg_HEADER} to GLSL"
            VERBATIM)
    endif()
    target_sources(${target} PRIVATE "${output}")
endfunction()
