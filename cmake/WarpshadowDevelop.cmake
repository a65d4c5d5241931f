# Flags for what is compiled in this repository: tests, tools, lab, samples, benchmarks. Users of
# the headers get none of them.

# Link this to every target of the repository: the warnings that everything is free of.
# CMAKE_COMPILE_WARNING_AS_ERROR (set by the presets) turns them into errors.
add_library(warpshadow_warnings INTERFACE)
target_compile_options(warpshadow_warnings INTERFACE
    $<$<COMPILE_LANGUAGE:CXX>:-Wall;-Wextra;-Wpedantic;-Wconversion;-Wsign-conversion;-Wshadow;-Wdouble-promotion>)

# Link this to what compares floating-point results to the bit. GCC 12 at -O2 drops the rounding of
# double -> float -> double when it vectorises adjacent lanes, hence the second flag.
add_library(warpshadow_exact INTERFACE)
target_compile_options(warpshadow_exact INTERFACE -ffp-contract=off -fno-tree-slp-vectorize)

if(PROJECT_IS_TOP_LEVEL)
    set(CMAKE_CXX_EXTENSIONS OFF)
    set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
    set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/bin")
    if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
        set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
    endif()

    # ccache, where it is installed, unless a launcher was chosen.
    find_program(WARPSHADOW_CCACHE ccache)
    mark_as_advanced(WARPSHADOW_CCACHE)
    if(WARPSHADOW_CCACHE)
        foreach(language IN ITEMS C CXX)
            if(NOT CMAKE_${language}_COMPILER_LAUNCHER)
                set(CMAKE_${language}_COMPILER_LAUNCHER "${WARPSHADOW_CCACHE}")
            endif()
        endforeach()
    endif()

    if(WARPSHADOW_SANITIZE)
        add_compile_options(-fsanitize=${WARPSHADOW_SANITIZE} -fno-sanitize-recover=all
                            -fno-omit-frame-pointer)
        add_link_options(-fsanitize=${WARPSHADOW_SANITIZE})
        # Bounds checks of std::span, std::array and so on.
        add_compile_definitions(_GLIBCXX_ASSERTIONS)
    endif()
endif()
