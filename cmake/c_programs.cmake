# What tests run of C: the examples, and plug-ins that are wrong. C89, as whoever writes firmware has it.

# The compiler of the same maker: options of linkers and sanitizers hold for both languages.
if(NOT DEFINED CMAKE_C_COMPILER)
  string(REPLACE "clang++" "clang" c_compiler "${CMAKE_CXX_COMPILER}")
  string(REPLACE "g++" "gcc" c_compiler "${c_compiler}")
  if(NOT c_compiler STREQUAL CMAKE_CXX_COMPILER)
    set(CMAKE_C_COMPILER "${c_compiler}" CACHE FILEPATH "Compiler of the examples and plug-ins in C")
  endif()
endif()
enable_language(C)

# fieldproof_c89(target): strict, and any warning is an error. A plug-in exports its entry alone.
function(fieldproof_c89 target)
  set_target_properties(${target} PROPERTIES
    C_STANDARD 90 C_STANDARD_REQUIRED ON C_EXTENSIONS OFF PREFIX "" C_VISIBILITY_PRESET hidden)
  target_include_directories(${target} PRIVATE "${CMAKE_SOURCE_DIR}")
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror)
endfunction()

add_executable(valve_node_process examples/valve_node/process.c examples/valve_node/valve_node.c)
fieldproof_c89(valve_node_process)
add_library(valve_node_plugin MODULE examples/valve_node/plugin.c examples/valve_node/valve_node.c)
fieldproof_c89(valve_node_plugin)
# As its first comment tells users to build it.
if(NOT FIELDPROOF_SANITIZE AND NOT FIELDPROOF_COVERAGE AND CMAKE_C_COMPILER_ID STREQUAL "GNU")
  set_target_properties(valve_node_plugin PROPERTIES INTERPROCEDURAL_OPTIMIZATION ON)
  target_link_options(valve_node_plugin PRIVATE -fuse-ld=bfd)  # lld does not know the objects of g++
endif()

# The same node as whoever fuzzes it builds it.
add_library(counting_node MODULE examples/valve_node/plugin.c examples/valve_node/valve_node.c)
fieldproof_c89(counting_node)
target_compile_options(counting_node PRIVATE -O1 -fsanitize-coverage=trace-pc)

# fieldproof_odd_plugins(test): libraries that no station would be, and their paths for the test.
function(fieldproof_odd_plugins test)
  foreach(kind IN ITEMS "" _OTHER_VERSION _LEAVES_OUT _NO_ENTRY _LEVELS_ONLY)
    string(TOLOWER odd_plugin${kind} name)
    add_library(${name} MODULE harness/iut/odd_plugin.c)
    fieldproof_c89(${name})
    if(kind)
      string(SUBSTRING ${kind} 1 -1 definition)
      target_compile_definitions(${name} PRIVATE ${definition})
    endif()
    add_dependencies(${test} ${name})
    target_compile_definitions(${test} PRIVATE ODD_PLUGIN${kind}="$<TARGET_FILE:${name}>")
  endforeach()
endfunction()

# fieldproof_counting_libraries(test): libraries that report where they pass, in each way, and their paths for the test.
function(fieldproof_counting_libraries test)
  foreach(kind IN ITEMS _COUNTERS _GUARDS _CALLS)
    string(TOLOWER counting_library${kind} name)
    add_library(${name} MODULE fuzz/search/counting_library.c)
    fieldproof_c89(${name})
    target_compile_definitions(${name} PRIVATE ${kind})
    add_dependencies(${test} ${name})
    target_compile_definitions(${test} PRIVATE COUNTING_LIBRARY${kind}="$<TARGET_FILE:${name}>")
  endforeach()
  target_compile_options(counting_library_calls PRIVATE -fsanitize-coverage=trace-pc)
endfunction()

# fieldproof_link_valve_node(target): the node in C within the program, and the path of it as a library.
function(fieldproof_link_valve_node target)
  add_library(valve_node_objects OBJECT examples/valve_node/valve_node.c)
  fieldproof_c89(valve_node_objects)
  target_sources(${target} PRIVATE $<TARGET_OBJECTS:valve_node_objects>)
  add_dependencies(${target} valve_node_plugin)
  target_compile_definitions(${target} PRIVATE FIELDPROOF_VALVE_NODE_PLUGIN="$<TARGET_FILE:valve_node_plugin>")
endfunction()
