# Fails when a file includes a folder that it must not know: stages of core see only earlier stages,
# api and core do not see each other, nobody but the server sees the server, and of the libraries
# tinygltf and httplib are each seen by one file.
set(core_chain core core/numerics core/load core/weld core/geodesic core/locate core/cut core/landmarks core/fan core/border
               core/parameterize core/constrain core/layout core/outline core/measure core/map core/export core/sample)

file(GLOB_RECURSE sources RELATIVE ${ROOT} ${ROOT}/core/*.h ${ROOT}/core/*.cpp ${ROOT}/api/*.h
     ${ROOT}/api/*.cpp ${ROOT}/server/*.h ${ROOT}/server/*.cpp)
if(NOT sources)
    message(FATAL_ERROR "No sources under ${ROOT}")
endif()
set(broken "")
foreach(source IN LISTS sources)
    get_filename_component(folder ${source} DIRECTORY)
    file(STRINGS ${ROOT}/${source} includes REGEX "^#include \"")
    foreach(line IN LISTS includes)
        string(REGEX REPLACE "^#include \"([^\"]+)/[^/\"]+\".*" "\\1" target "${line}")
        if(folder MATCHES "^core" AND target MATCHES "^(api|server|tests)" OR
           folder MATCHES "^api" AND target MATCHES "^(core|server|tests)" OR
           folder STREQUAL "server/http" AND NOT target STREQUAL "server/http")
            list(APPEND broken "${source} -> ${target}")
        endif()
        # Writing a result needs the whole result; everything else looks up the chain only.
        if(folder STREQUAL "core/export" AND line MATCHES "core/flatten.h")
            continue()
        endif()
        list(FIND core_chain ${folder} here)
        list(FIND core_chain ${target} there)
        if(folder MATCHES "^core" AND here EQUAL -1)
            list(APPEND broken "${source}: ${folder} is not in the chain")
        endif()
        if(here GREATER 0 AND (there GREATER here OR line MATCHES "core/flatten.h"))
            list(APPEND broken "${source} -> ${target} (a later stage)")
        endif()
    endforeach()
    file(STRINGS ${ROOT}/${source} libraries REGEX "^#include <(tiny_gltf|httplib)")
    if(libraries AND NOT source STREQUAL "core/load/tinygltf.h" AND NOT source STREQUAL "server/http/library.cpp")
        list(APPEND broken "${source} -> ${libraries}")
    endif()
endforeach()
if(broken)
    list(JOIN broken "\n  " text)
    message(FATAL_ERROR "Includes against the direction:\n  ${text}")
endif()
