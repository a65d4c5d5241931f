# What every consumer does once it has the target.
add_executable(consumer ../consumer.cpp)
target_link_libraries(consumer PRIVATE warpshadow::warpshadow)
if(NOT EXISTS "${warpshadow_GLSL_DIR}/warpshadow/warp.glsl")
    message(FATAL_ERROR "warpshadow_GLSL_DIR (${warpshadow_GLSL_DIR}) does not lead to the GLSL")
endif()
if(TARGET warpshadow_catch_main OR TARGET warpshadow-lab)
    message(FATAL_ERROR "tests and lab are built although warpshadow is not the top-level project")
endif()
