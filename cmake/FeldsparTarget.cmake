# How our own targets are compiled: warnings are errors, and the same source gives the same bits on every code path.
add_library(feldspar_options INTERFACE)
target_include_directories(feldspar_options INTERFACE ${CMAKE_SOURCE_DIR}/src)
set(feldspar_flags
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Werror
    $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>  # GCC 12 sees overlaps in std::string concatenation that are not there (its bug 105651)
    -ffp-contract=off     # no fused multiply-add that one path has and another has not
    -fno-math-errno)
target_compile_options(feldspar_options INTERFACE "$<$<NOT:$<COMPILE_LANGUAGE:CUDA>>:${feldspar_flags}>")
if(FELDSPAR_SANITIZE)
    target_compile_options(feldspar_options INTERFACE "$<$<NOT:$<COMPILE_LANGUAGE:CUDA>>:-fsanitize=${FELDSPAR_SANITIZE};-fno-omit-frame-pointer>")
    target_link_options(feldspar_options INTERFACE -fsanitize=${FELDSPAR_SANITIZE})
endif()
if(FELDSPAR_FUZZ)
    if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
        message(FATAL_ERROR "FELDSPAR_FUZZ needs Clang: cmake --preset asan-ubsan")
    endif()
    target_compile_options(feldspar_options INTERFACE -fsanitize=fuzzer-no-link -fno-sanitize-recover=all -Wno-error)  # GCC's warnings are the measure
endif()

# feldspar_room(NAME SOURCES ... DEPENDS ...): one room of the house as a static library `feldspar_NAME`. DEPENDS names
# rooms of floors above it and libraries, so a forbidden dependency does not link.
function(feldspar_room name)
    cmake_parse_arguments(ROOM "" "" "SOURCES;DEPENDS" ${ARGN})
    add_library(feldspar_${name} STATIC ${ROOM_SOURCES})
    target_link_libraries(feldspar_${name} PUBLIC ${ROOM_DEPENDS} PRIVATE $<BUILD_INTERFACE:feldspar_options>)
    target_include_directories(feldspar_${name} PUBLIC $<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}/src> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
    target_compile_features(feldspar_${name} PUBLIC cxx_std_20)
    set_target_properties(feldspar_${name} PROPERTIES EXPORT_NAME ${name})
    set_property(GLOBAL APPEND PROPERTY FELDSPAR_ROOMS feldspar_${name})
    if(FELDSPAR_WITH_PYTHON)
        # Hidden, so that calls inside the library stay direct: no slower than a program's own code (docs/decisions, Python module).
        set_target_properties(feldspar_${name} PROPERTIES POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
    endif()
endfunction()

# feldspar_test(NAME SOURCES ... DEPENDS ... LABELS ... [TIMEOUT s]): one GoogleTest program; each of its tests is a CTest.
function(feldspar_test name)
    cmake_parse_arguments(TEST "" "TIMEOUT" "SOURCES;DEPENDS;LABELS" ${ARGN})
    if(NOT TEST_LABELS)
        set(TEST_LABELS fast)
    endif()
    if(NOT TEST_TIMEOUT)
        set(TEST_TIMEOUT 300)
    endif()
    add_executable(${name} ${TEST_SOURCES})
    target_link_libraries(${name} PRIVATE ${TEST_DEPENDS} GTest::gtest_main feldspar_options)
    target_compile_definitions(${name} PRIVATE FELDSPAR_SOURCE_DIR="${CMAKE_SOURCE_DIR}" FELDSPAR_PROGRAM="${CMAKE_BINARY_DIR}/feldspar")
    gtest_discover_tests(${name} NO_PRETTY_VALUES PROPERTIES LABELS "${TEST_LABELS}" TIMEOUT ${TEST_TIMEOUT} DISCOVERY_TIMEOUT 60)
endfunction()
