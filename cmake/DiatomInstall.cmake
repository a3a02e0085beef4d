# What `cmake --install` puts where, in three components: diatom (command line, plugins, samples), studio (desktop) and
# sdk (headers, CMake package, templates). Programs find the rest from where they lie: <bin>/../lib/diatom, <bin>/../share/diatom.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(CMAKE_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(share share/diatom)

install(TARGETS diatom-cli diatom-worker RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT diatom)
install(DIRECTORY resources/samples resources/verification resources/schema DESTINATION ${share} COMPONENT diatom)
install(FILES LICENSE CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT diatom)
if(TARGET diatom-studio)
  install(TARGETS diatom-studio RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT studio)
  install(FILES resources/diatom-studio.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications COMPONENT studio)
endif()

# The SDK. Its version is that of the plugin interface, which is what a plugin is built for; the program has its own.
file(READ plugins/sdk/include/diatom/abi/core.h core)
string(REGEX MATCH "DIATOM_ABI_MAJOR ([0-9]+)" _ "${core}")
set(sdk_version ${CMAKE_MATCH_1})
string(REGEX MATCH "DIATOM_ABI_MINOR ([0-9]+)" _ "${core}")
string(APPEND sdk_version .${CMAKE_MATCH_1})
set(package share/cmake/DiatomSdk) # nothing in it depends on the processor
write_basic_package_version_file(${CMAKE_BINARY_DIR}/DiatomSdkConfigVersion.cmake
  VERSION ${sdk_version} COMPATIBILITY SameMajorVersion ARCH_INDEPENDENT)
set_target_properties(diatom_sdk PROPERTIES EXPORT_NAME Sdk)
install(TARGETS diatom_sdk EXPORT DiatomSdk INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT DiatomSdk NAMESPACE DiatomSdk:: FILE DiatomSdkTargets.cmake DESTINATION ${package} COMPONENT sdk)
install(FILES plugins/sdk/cmake/DiatomSdkConfig.cmake plugins/sdk/cmake/DiatomPlugin.cmake plugins/sdk/cmake/DiatomGolden.cmake
  plugins/sdk/cmake/exports.map ${CMAKE_BINARY_DIR}/DiatomSdkConfigVersion.cmake DESTINATION ${package} COMPONENT sdk)
install(DIRECTORY plugins/sdk/include/diatom DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT sdk)
install(DIRECTORY plugins/sdk/templates DESTINATION ${share} COMPONENT sdk)
install(FILES docs/adding-a-plugin.md DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/diatom-sdk COMPONENT sdk)
if(TARGET diatom-plugin-check)
  install(TARGETS diatom-plugin-check RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT sdk)
endif()
