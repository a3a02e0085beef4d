# Plugins of Diatom: diatom_add_plugin() builds one, diatom_add_golden_test() holds what it does to what it did.

set(DIATOM_PLUGIN_CMAKE_DIR ${CMAKE_CURRENT_LIST_DIR})

# The folder that plugins of this manifest's kind lie in: diatom.lattice/1 -> lattices.
function(diatom_plugin_kind json result)
  string(JSON interface GET "${json}" provides 0 interface)
  string(REGEX REPLACE "^diatom\\.([a-z]+)/.*$" "\\1s" kind "${interface}")
  string(REPLACE "partss" "parts" kind "${kind}")
  set(${result} ${kind} PARENT_SCOPE)
endfunction()

# Relaxed arithmetic changes results, and linking with it changes the host's arithmetic as well.
function(diatom_refuse_fast_math target)
  string(TOUPPER "${CMAKE_BUILD_TYPE}" type)
  get_property(options DIRECTORY PROPERTY COMPILE_OPTIONS)
  foreach(name CMAKE_C_FLAGS CMAKE_C_FLAGS_${type} CMAKE_CXX_FLAGS CMAKE_CXX_FLAGS_${type} CMAKE_MODULE_LINKER_FLAGS options)
    if("${${name}}" MATCHES "-(ffast-math|Ofast|funsafe-math-optimizations)")
      message(FATAL_ERROR "${target} cannot be built with -${CMAKE_MATCH_1} (in ${name}): it would change the results of "
        "Diatom itself, which must be the same everywhere. Take the flag out.")
    endif()
  endforeach()
endfunction()

# The module carries the very bytes of plugin.json, so that a half-updated install is noticed.
function(diatom_embed_manifest target folder header)
  file(READ ${folder}/plugin.json hex HEX)
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "'\\\\x\\1'," bytes "${hex}")
  file(CONFIGURE OUTPUT ${header} CONTENT
    "#ifdef __FAST_MATH__
#error \"plugins of Diatom cannot be built with -ffast-math or -Ofast: take the flag out\"
#endif
static const char diatom_plugin_metadata[] = {@bytes@'\\0'};\n" @ONLY)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${folder}/plugin.json)
endfunction()

# diatom_add_plugin([FOLDER] [SOURCES FILE...] [DATA FILE...]): builds the plugin in FOLDER (plugin.json and sources) with
# the flags the ABI needs: hidden symbols, one export, no FMA contraction, no undefined symbols, never unloaded, manifest
# embedded. A folder within a larger tree is KIND/NAME and all of its sources are the plugin's. Without FOLDER the project
# itself is the plugin: the manifest says the kind, the project's name is the plugin's, its target and its folder's. DATA is
# copied beside the library.
function(diatom_add_plugin)
  cmake_parse_arguments(PARSE_ARGV 0 plugin "" "" "SOURCES;DATA")
  if(plugin_UNPARSED_ARGUMENTS)
    list(GET plugin_UNPARSED_ARGUMENTS 0 folder)
    get_filename_component(name ${folder} NAME)
    get_filename_component(kind ${folder} DIRECTORY)
    get_filename_component(kind ${kind} NAME)
    set(target plugin_${kind}_${name})
    set(output ${DIATOM_PLUGIN_OUTPUT_DIRECTORY}/${kind}/${name})
  else()
    set(folder ${CMAKE_CURRENT_SOURCE_DIR})
    set(name ${PROJECT_NAME})
    set(target ${PROJECT_NAME})
    file(READ ${folder}/plugin.json json)
    diatom_plugin_kind("${json}" kind)
    set(output ${CMAKE_CURRENT_BINARY_DIR}/${name}) # diatom --plugins build
  endif()
  set(sources ${plugin_SOURCES})
  if(NOT sources)
    file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${folder}/*.cpp ${folder}/*.c)
  endif()
  diatom_refuse_fast_math(${name})
  set(embedded ${CMAKE_CURRENT_BINARY_DIR}/${target}_metadata.h)
  diatom_embed_manifest(${target} ${folder} ${embedded})

  add_library(${target} MODULE ${sources})
  set_property(GLOBAL APPEND PROPERTY DIATOM_PLUGIN_TARGETS ${target})
  target_include_directories(${target} PRIVATE ${folder}) # a larger plugin has folders of its own
  target_link_libraries(${target} PRIVATE Diatom::Sdk)
  get_property(languages GLOBAL PROPERTY ENABLED_LANGUAGES)
  if("CXX" IN_LIST languages)
    target_compile_features(${target} PRIVATE cxx_std_20)
  endif()
  if("C" IN_LIST languages)
    target_compile_features(${target} PRIVATE c_std_11)
  endif()
  target_compile_definitions(${target} PRIVATE DIATOM_PLUGIN_METADATA="${embedded}")
  target_compile_options(${target} PRIVATE -ffp-contract=off)
  target_link_options(${target} PRIVATE -Wl,-z,nodelete
    -Wl,--version-script=${DIATOM_PLUGIN_CMAKE_DIR}/exports.map)
  if(NOT DIATOM_SANITIZE)
    target_link_options(${target} PRIVATE -Wl,-z,defs)
  endif()
  set_target_properties(${target} PROPERTIES PREFIX "" OUTPUT_NAME ${name} POSITION_INDEPENDENT_CODE ON
    C_VISIBILITY_PRESET hidden CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON
    LIBRARY_OUTPUT_DIRECTORY ${output})
  foreach(file plugin.json ${plugin_DATA})
    get_filename_component(last ${file} NAME)
    add_custom_command(TARGET ${target} POST_BUILD
      COMMAND ${CMAKE_COMMAND} -E copy_if_different ${folder}/${file} ${output}/${last})
  endforeach()
  if(DIATOM_PLUGIN_INSTALL_DIRECTORY)
    if(NOT DIATOM_PLUGIN_INSTALL_COMPONENT)
      set(DIATOM_PLUGIN_INSTALL_COMPONENT plugin)
    endif()
    set(destination ${DIATOM_PLUGIN_INSTALL_DIRECTORY}/${kind}/${name})
    install(TARGETS ${target} LIBRARY DESTINATION ${destination} COMPONENT ${DIATOM_PLUGIN_INSTALL_COMPONENT})
    install(DIRECTORY ${output}/ DESTINATION ${destination} COMPONENT ${DIATOM_PLUGIN_INSTALL_COMPONENT}
      PATTERN ${name}.so EXCLUDE)
  endif()
  if(COMMAND diatom_warnings)
    diatom_warnings(${target})
    diatom_unity(${target})
  endif()
  # A plugin may need more than the SDK (Qt for scripts): its own optional plugin.cmake says so.
  if(EXISTS ${folder}/plugin.cmake)
    include(${folder}/plugin.cmake)
  endif()
endfunction()

# diatom_add_golden_test(NAME EXPECTED FILE COMMAND WORD...): a ctest in which `diatom WORD...`, run in the project's folder
# and with the project's plugin, must print what FILE holds. Without the program there is none, and configuring says so.
function(diatom_add_golden_test name)
  cmake_parse_arguments(PARSE_ARGV 1 golden "" "EXPECTED" "COMMAND")
  if(NOT DIATOM_PROGRAM)
    message(STATUS "diatom was not found: the test ${name} is left out (-DDIATOM_PROGRAM=...)")
    return()
  endif()
  set(command ${DIATOM_PROGRAM} --plugins ${CMAKE_CURRENT_BINARY_DIR} --progress none ${golden_COMMAND})
  # By the project's name: ctest mixes up tests of one name where several plugins are built together.
  add_test(NAME ${PROJECT_NAME}_${name} WORKING_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} COMMAND ${CMAKE_COMMAND}
    "-DCOMMAND=${command}" -DACTUAL=${CMAKE_CURRENT_BINARY_DIR}/${name}.actual
    -DEXPECTED=${CMAKE_CURRENT_SOURCE_DIR}/${golden_EXPECTED} -P ${DIATOM_PLUGIN_CMAKE_DIR}/DiatomGolden.cmake)
endfunction()

# diatom_add_plugin_test(NAME SOURCES FILE...): a program built with the plugin's flags, and a ctest that runs it. It includes
# the plugin's sources or headers; after diatom_add_plugin().
function(diatom_add_plugin_test name)
  cmake_parse_arguments(PARSE_ARGV 1 test "" "" "SOURCES")
  add_executable(${name} ${test_SOURCES})
  target_link_libraries(${name} PRIVATE Diatom::Sdk)
  target_compile_features(${name} PRIVATE cxx_std_20)
  target_compile_options(${name} PRIVATE -ffp-contract=off)
  target_compile_definitions(${name} PRIVATE
    DIATOM_PLUGIN_METADATA="${CMAKE_CURRENT_BINARY_DIR}/${PROJECT_NAME}_metadata.h")
  add_test(NAME ${PROJECT_NAME}_${name} COMMAND ${name})
endfunction()

# diatom_add_conformance_test([DESIGNS FILE...]): a ctest that runs the conformance program on the project's plugin, where that
# program is installed; designs are what the plugin is tried on beside what the program makes itself. Warnings pass.
function(diatom_add_conformance_test)
  cmake_parse_arguments(PARSE_ARGV 0 conformance "" "" "DESIGNS")
  if(NOT DIATOM_PLUGIN_CHECK_PROGRAM)
    message(STATUS "diatom-plugin-check was not found: the test conformance is left out (-DDIATOM_PLUGIN_CHECK_PROGRAM=...)")
    return()
  endif()
  set(designs "")
  foreach(file IN LISTS conformance_DESIGNS)
    list(APPEND designs --design ${CMAKE_CURRENT_SOURCE_DIR}/${file})
  endforeach()
  add_test(NAME ${PROJECT_NAME}_conformance
    COMMAND ${DIATOM_PLUGIN_CHECK_PROGRAM} $<TARGET_FILE_DIR:${PROJECT_NAME}> ${designs})
  set_tests_properties(${PROJECT_NAME}_conformance PROPERTIES PASS_REGULAR_EXPRESSION ", 0 failed")
endfunction()
