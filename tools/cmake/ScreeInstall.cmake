# Install and export: find_package(scree) gives scree::core and what it stands on.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
install(TARGETS scree_base scree_kernels scree_shapes scree_core EXPORT scree-targets FILE_SET HEADERS DESTINATION include/scree)
install(EXPORT scree-targets NAMESPACE scree:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/scree)
configure_package_config_file(${CMAKE_SOURCE_DIR}/tools/cmake/scree-config.cmake.in ${CMAKE_BINARY_DIR}/scree-config.cmake
                              INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/scree)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/scree-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/scree-config.cmake ${CMAKE_BINARY_DIR}/scree-config-version.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/scree)
install(FILES ${CMAKE_SOURCE_DIR}/shapes/library/grains.h5 DESTINATION ${CMAKE_INSTALL_DATADIR}/scree)
