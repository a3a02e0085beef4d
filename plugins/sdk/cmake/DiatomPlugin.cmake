# diatom_add_plugin(FOLDER): builds the plugin in FOLDER (plugin.json and sources) with the flags the ABI needs: hidden
# symbols, one export, no FMA contraction, no undefined symbols, never unloaded, manifest embedded.

set(DIATOM_PLUGIN_CMAKE_DIR ${CMAKE_CURRENT_LIST_DIR})

function(diatom_add_plugin folder)
  get_filename_component(name ${folder} NAME)
  get_filename_component(kind ${folder} DIRECTORY)
  get_filename_component(kind ${kind} NAME)
  set(target plugin_${kind}_${name})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${folder}/*.cpp ${folder}/*.c)

  # The module carries the very bytes of plugin.json, so that a half-updated install is noticed.
  set(embedded ${CMAKE_CURRENT_BINARY_DIR}/${target}_metadata.h)
  file(READ ${folder}/plugin.json json HEX)
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "'\\\\x\\1'," bytes "${json}")
  file(CONFIGURE OUTPUT ${embedded} CONTENT
    "static const char diatom_plugin_metadata[] = {@bytes@'\\0'};\n" @ONLY)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${folder}/plugin.json)

  add_library(${target} MODULE ${sources})
  set_property(GLOBAL APPEND PROPERTY DIATOM_PLUGIN_TARGETS ${target})
  target_include_directories(${target} PRIVATE ${folder}) # a larger plugin has folders of its own
  target_link_libraries(${target} PRIVATE Diatom::Sdk)
  target_compile_features(${target} PRIVATE cxx_std_20 c_std_11)
  target_compile_definitions(${target} PRIVATE DIATOM_PLUGIN_METADATA="${embedded}")
  target_compile_options(${target} PRIVATE -ffp-contract=off)
  target_link_options(${target} PRIVATE -Wl,-z,nodelete
    -Wl,--version-script=${DIATOM_PLUGIN_CMAKE_DIR}/exports.map)
  if(NOT DIATOM_SANITIZE)
    target_link_options(${target} PRIVATE -Wl,-z,defs)
  endif()
  set_target_properties(${target} PROPERTIES PREFIX "" OUTPUT_NAME ${name}
    C_VISIBILITY_PRESET hidden CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON
    LIBRARY_OUTPUT_DIRECTORY ${DIATOM_PLUGIN_OUTPUT_DIRECTORY}/${kind}/${name})
  add_custom_command(TARGET ${target} POST_BUILD
    COMMAND ${CMAKE_COMMAND} -E copy_if_different ${folder}/plugin.json
      ${DIATOM_PLUGIN_OUTPUT_DIRECTORY}/${kind}/${name}/plugin.json)
  if(COMMAND diatom_warnings)
    diatom_warnings(${target})
    diatom_unity(${target})
  endif()
  # A plugin may need more than the SDK (Qt for scripts): its own optional plugin.cmake says so.
  if(EXISTS ${folder}/plugin.cmake)
    include(${folder}/plugin.cmake)
  endif()
endfunction()
