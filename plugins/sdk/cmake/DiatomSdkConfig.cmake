# find_package(DiatomSdk): headers as DiatomSdk::Sdk (also Diatom::Sdk), and diatom_add_plugin(). Its version is that of
# the plugin interface.
include(${CMAKE_CURRENT_LIST_DIR}/DiatomSdkTargets.cmake)
if(NOT TARGET Diatom::Sdk)
  add_library(Diatom::Sdk ALIAS DiatomSdk::Sdk)
endif()

# Where Diatom looks for a user's plugins. For a package of your own: lib/diatom/plugins/1, which is then below the prefix.
if(IS_ABSOLUTE "$ENV{XDG_DATA_HOME}")
  set(diatom_data "$ENV{XDG_DATA_HOME}")
else()
  set(diatom_data "$ENV{HOME}/.local/share")
endif()
set(DIATOM_PLUGIN_INSTALL_DIRECTORY ${diatom_data}/diatom/plugins/1 CACHE PATH "Where `cmake --install` puts plugins")
unset(diatom_data)

# The program that lies beside the SDK comes before any other: plugins are tried with it.
get_filename_component(diatom_prefix ${CMAKE_CURRENT_LIST_DIR}/../../.. ABSOLUTE)
find_program(DIATOM_PROGRAM diatom HINTS ${diatom_prefix}/bin DOC "diatom, which tests of plugins run")
find_program(DIATOM_PLUGIN_CHECK_PROGRAM diatom-plugin-check HINTS ${diatom_prefix}/bin DOC "The conformance program")
unset(diatom_prefix)

include(${CMAKE_CURRENT_LIST_DIR}/DiatomPlugin.cmake)
