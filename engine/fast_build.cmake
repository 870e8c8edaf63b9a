# Halves the time of a build from nothing, and changes no result. Included by the root after palp_build_flags.

# Flags and a launcher that somebody set are left as they are: a launcher of ccache, for one, cannot cache what uses a
# precompiled header unless it is told so.
set(PALPATE_PRECOMPILE FALSE)
set(PALPATE_LIGHT_FLAGS "")
if(PALPATE_FAST_BUILD AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
    set(PALPATE_PRECOMPILE TRUE)
    find_program(PALPATE_CCACHE ccache DOC "ccache, which makes the next build from nothing faster (package ccache)")
    if(PALPATE_CCACHE)
        set(CMAKE_CXX_COMPILER_LAUNCHER "${CMAKE_COMMAND}" -E env CCACHE_SLOPPINESS=pch_defines,time_macros CCACHE_DEPEND=1 "${PALPATE_CCACHE}")
        target_compile_options(palp_build_flags INTERFACE $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)
    endif()
endif()
if(PALPATE_FAST_BUILD AND "${CMAKE_CXX_FLAGS_RELEASE}" STREQUAL "-O3 -DNDEBUG")
    set(PALPATE_LIGHT_FLAGS $<$<CONFIG:Release>:-O1>)
endif()

# What many sources include and nobody changes. Each source still names what it uses: palp_headers_test and a build with
# PALPATE_FAST_BUILD=OFF see to it.
set(palp_standard_headers <algorithm> <array> <atomic> <chrono> <cmath> <cstdint> <cstdio> <cstring> <filesystem> <fstream>
    <functional> <iostream> <limits> <map> <memory> <numbers> <optional> <span> <sstream> <string> <string_view> <thread>
    <utility> <vector> <glm/common.hpp> <glm/geometric.hpp> <glm/mat3x3.hpp> <glm/vec2.hpp> <glm/vec3.hpp> <glm/gtc/quaternion.hpp>)

# palp_precompiled(<name> HEADERS <header...> [LINK <target...>] [FLAGS <flag...>] [PROGRAM])
# Precompiles headers for palp_precompile(<target> <name>). PROGRAM: for sources of programs rather than of libraries,
# which are compiled for other addresses.
function(palp_precompiled name)
    cmake_parse_arguments(HEAD "PROGRAM" "" "HEADERS;LINK;FLAGS" ${ARGN})
    if(NOT PALPATE_PRECOMPILE)
        return()
    endif()
    set(source "${CMAKE_CURRENT_BINARY_DIR}/palp_precompiled_${name}.cpp")
    file(CONFIGURE OUTPUT "${source}" CONTENT "int main() {}\n")
    if(HEAD_PROGRAM)
        add_executable(palp_precompiled_${name} "${source}")
    else()
        add_library(palp_precompiled_${name} OBJECT "${source}")
    endif()
    target_compile_features(palp_precompiled_${name} PRIVATE cxx_std_20)
    target_link_libraries(palp_precompiled_${name} PRIVATE palp_build_flags ${HEAD_LINK})
    target_compile_options(palp_precompiled_${name} PRIVATE ${HEAD_FLAGS})
    target_precompile_headers(palp_precompiled_${name} PRIVATE ${HEAD_HEADERS})
endfunction()

function(palp_precompile target name)
    if(PALPATE_PRECOMPILE)
        target_precompile_headers(${target} REUSE_FROM palp_precompiled_${name})
        # GCC 12 forgets that what it precompiled are the system's headers, and warns of their insides.
        target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds -Wno-restrict -Wno-stringop-overflow -Wno-stringop-overread>)
    endif()
endfunction()
