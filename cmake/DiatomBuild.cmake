# Settings every target of ours shares: language, warnings, bits, sanitizers, output folders.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_C_STANDARD 11)
set(CMAKE_C_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

# Executables find the plugins beside them: <bin>/../plugins/<kind>/<name>/plugin.json.
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
set(DIATOM_PLUGIN_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/plugins)

if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE RelWithDebInfo CACHE STRING "Build type" FORCE)
endif()

find_program(DIATOM_CCACHE ccache)
if(DIATOM_CCACHE)
  set(CMAKE_C_COMPILER_LAUNCHER ${DIATOM_CCACHE})
  set(CMAKE_CXX_COMPILER_LAUNCHER ${DIATOM_CCACHE})
endif()
find_program(DIATOM_MOLD mold)
if(DIATOM_MOLD)
  add_link_options(-fuse-ld=mold)
endif()

# Without contraction SSE2, AVX2 and AVX-512 builds give the same bits.
add_compile_options(-ffp-contract=off)

if(DIATOM_SANITIZE)
  # -O1 -g1: with more of either, g++ takes ten times as long over a chunk of the command line.
  add_compile_options(-fsanitize=${DIATOM_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all -O1 -g1)
  add_link_options(-fsanitize=${DIATOM_SANITIZE})
endif()

if(DIATOM_FUZZ)
  add_compile_options(-fsanitize=fuzzer-no-link) # coverage of the library is what guides the fuzzer
endif()

# Warnings for our own targets, not for what they include from the system.
function(diatom_warnings target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
    -Wnon-virtual-dtor -Woverloaded-virtual -Wcast-qual)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(${target} PRIVATE -Wno-restrict) # GCC 12 finds overlaps in std::string that are not there (bug 105651)
    if(DIATOM_SANITIZE)
      target_compile_options(${target} PRIVATE -Wno-maybe-uninitialized) # nor what it finds in its own std::regex then (bug 105562)
    endif()
  endif()
  if(DIATOM_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
endfunction()

# Compiles a target's files in chunks of a folder: most of a cold build is reading the same headers again. Presets that
# people edit with, and the one for clang, compile each file by itself and so show what a file forgot to include.
option(DIATOM_UNITY "Compile several files of a folder at once: a cold build takes a third, a small edit longer" OFF)
function(diatom_unity target)
  if(NOT DIATOM_UNITY)
    return()
  endif()
  get_target_property(sources ${target} SOURCES)
  foreach(source IN LISTS sources)
    if(NOT source MATCHES "\\.cpp$")
      continue()
    endif()
    get_filename_component(folder ${source} DIRECTORY)
    string(MAKE_C_IDENTIFIER "${folder}" folder)
    list(APPEND folder_${folder} ${source})
    list(LENGTH folder_${folder} place)
    math(EXPR chunk "(${place} - 1) / 8")
    set_property(SOURCE ${source} PROPERTY UNITY_GROUP "${folder}_${chunk}")
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()
