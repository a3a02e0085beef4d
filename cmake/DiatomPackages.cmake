# Debian packages by `cpack -G DEB` in the build folder: diatom, diatom-studio and diatom-sdk.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME diatom)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_CONTACT "The Diatom developers <diatom@project.invalid>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_COMPONENTS_ALL diatom sdk)
if(TARGET diatom-studio)
  list(APPEND CPACK_COMPONENTS_ALL studio)
endif()

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_DIATOM_PACKAGE_NAME diatom)
set(CPACK_DEBIAN_STUDIO_PACKAGE_NAME diatom-studio)
set(CPACK_DEBIAN_SDK_PACKAGE_NAME diatom-sdk)
set(CPACK_COMPONENT_DIATOM_DESCRIPTION "Design, simulate and assemble digital materials: command line
Lattices, decompositions into parts, machines and solvers, as plugins, with
the program that works on designs without a display.")
set(CPACK_COMPONENT_STUDIO_DESCRIPTION "Design, simulate and assemble digital materials: desktop program
The graphical surface of diatom.")
set(CPACK_COMPONENT_SDK_DESCRIPTION "Plugins for diatom: headers, CMake package and templates
What the author of a lattice, a decomposition, a machine or a solver needs.")
set(CPACK_DEBIAN_STUDIO_PACKAGE_DEPENDS "diatom (= ${PROJECT_VERSION})")
# Headers say what a plugin is; building and trying one takes these.
set(CPACK_DEBIAN_SDK_PACKAGE_DEPENDS "cmake (>= 3.25)")
set(CPACK_DEBIAN_SDK_PACKAGE_RECOMMENDS "diatom (= ${PROJECT_VERSION}), g++ | clang")
if(NOT TARGET diatom-plugin-check)
  set(CPACK_DEBIAN_SDK_PACKAGE_ARCHITECTURE all)
endif()
# PLplot draws by a driver that it loads by name, which shlibdeps cannot see.
set(CPACK_DEBIAN_DIATOM_PACKAGE_RECOMMENDS "plplot-driver-cairo")
include(CPack)
