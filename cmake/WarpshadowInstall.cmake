# Install rules: headers, GLSL and the CMake package.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(package_dir "${CMAKE_INSTALL_DATADIR}/cmake/warpshadow")

install(TARGETS warpshadow EXPORT warpshadowTargets)
install(DIRECTORY "${PROJECT_SOURCE_DIR}/include/warpshadow" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}")
if(EXISTS "${PROJECT_SOURCE_DIR}/glsl")
    install(DIRECTORY "${PROJECT_SOURCE_DIR}/glsl" DESTINATION "${CMAKE_INSTALL_DATADIR}/warpshadow")
endif()
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/warpshadow")

install(EXPORT warpshadowTargets NAMESPACE warpshadow:: DESTINATION "${package_dir}")
set(warpshadow_installed_glsl_dir "${CMAKE_INSTALL_DATADIR}/warpshadow/glsl")
configure_package_config_file(
    "${PROJECT_SOURCE_DIR}/cmake/warpshadowConfig.cmake.in"
    "${PROJECT_BINARY_DIR}/warpshadowConfig.cmake"
    INSTALL_DESTINATION "${package_dir}"
    PATH_VARS warpshadow_installed_glsl_dir)
write_basic_package_version_file("${PROJECT_BINARY_DIR}/warpshadowConfigVersion.cmake"
    COMPATIBILITY SameMinorVersion ARCH_INDEPENDENT)
install(FILES "${PROJECT_BINARY_DIR}/warpshadowConfig.cmake"
              "${PROJECT_BINARY_DIR}/warpshadowConfigVersion.cmake"
        DESTINATION "${package_dir}")
if(EXISTS "${PROJECT_SOURCE_DIR}/cmake/WarpshadowGlsl.cmake")
    install(FILES "${PROJECT_SOURCE_DIR}/cmake/WarpshadowGlsl.cmake" DESTINATION "${package_dir}")
endif()
