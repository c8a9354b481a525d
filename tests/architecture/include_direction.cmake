# Fails when a file includes what it must not know, and when a folder stands in none of these lists.
cmake_minimum_required(VERSION 3.25)

# Core, in its order: each sees itself and those before it. An entry is a folder, a file directly in
# core, or a file that goes before or after the rest of its folder.
set(core_order numerics/types text utf8 error progress parallel append overloaded stopwatch request
    numerics load weld geodesic locate cut landmarks defeature plan cut/cut_surface fan border parameterize optimize constrain
    layout outline measure result map prepare solve assemble flatten session inspect export sample)

# The rooms of the server, in their order, each with what it knows beside itself.
set(server_rooms
    "support: api"
    "http: support api core"
    "jobs: support api"
    "storage: support jobs api"
    "protocol: support jobs api"
    "worker: support jobs protocol api core"
    "runner: support jobs protocol api"
    "webhooks: support jobs api"
    "routes: support http jobs protocol runner webhooks api"
    "cli: support http jobs storage protocol worker runner webhooks routes api core")

# Headers of libraries, and the only folder or file that includes them.
set(library_homes
    "tiny_gltf: core/load/tinygltf.h"
    "httplib: server/http/library.cpp"
    "openssl/: server/support/crypto.cpp"
    "spdlog/: server/support/log.cpp"
    "libdeflate: server/support/gzip.cpp"
    "SQLiteCpp/: server/storage/"
    "curl/: server/webhooks/"
    "CLI/: server/cli/")

set(broken "")
macro(complain what)
    list(APPEND broken "${what}")
endmacro()

# Where a file of core stands in `core_order`; -1: nowhere.
function(core_rank path rank)
    string(REGEX REPLACE "^core/(.+)\\.(h|cpp)$" "\\1" name ${path})
    list(FIND core_order ${name} found)
    if(found EQUAL -1)
        get_filename_component(folder ${name} DIRECTORY)
        list(FIND core_order "${folder}" found)
    endif()
    set(${rank} ${found} PARENT_SCOPE)
endfunction()

# The room of a path: "core", "api", or a room of the server; empty: none of them.
function(room_of path room)
    set(found "")
    if(path MATCHES "^(server/)?([^/]+)/")
        set(found ${CMAKE_MATCH_2})
    endif()
    set(${room} "${found}" PARENT_SCOPE)
endfunction()

set(known_core core)
set(known_api api core)
set(rooms core api)
foreach(line IN LISTS server_rooms)
    string(REGEX MATCHALL "[a-z]+" words "${line}")
    list(GET words 0 room)
    set(known_${room} ${words})
    list(REMOVE_AT words 0)
    foreach(word IN LISTS words)
        if(NOT word IN_LIST rooms)
            complain("server/${room} is to know ${word}, which does not stand before it")
        endif()
    endforeach()
    list(APPEND rooms ${room})
endforeach()

file(GLOB_RECURSE sources RELATIVE ${ROOT} ${ROOT}/core/*.h ${ROOT}/core/*.cpp ${ROOT}/api/*.h
     ${ROOT}/api/*.cpp ${ROOT}/server/*.h ${ROOT}/server/*.cpp)
if(NOT sources)
    message(FATAL_ERROR "No sources under ${ROOT}")
endif()
foreach(source IN LISTS sources)
    room_of(${source} room)
    if(NOT room IN_LIST rooms)
        complain("${source} is in no room")
        continue()
    endif()
    if(room STREQUAL "core")
        core_rank(${source} here)
        if(here EQUAL -1)
            complain("${source} is not in the order of core")
        endif()
    endif()
    file(STRINGS ${ROOT}/${source} includes REGEX "^#include \"")
    foreach(line IN LISTS includes)
        string(REGEX REPLACE "^#include \"([^\"]+)\".*" "\\1" header "${line}")
        room_of(${header} target)
        if(NOT target IN_LIST known_${room})
            complain("${source} -> ${header}")
        elseif(room STREQUAL "core")
            core_rank(${header} there)
            if(there GREATER here)
                complain("${source} -> ${header} (later)")
            endif()
        endif()
    endforeach()
    foreach(line IN LISTS library_homes)
        string(REGEX MATCH "^([^:]+): (.+)$" matched "${line}")
        set(home "${CMAKE_MATCH_2}")
        file(STRINGS ${ROOT}/${source} libraries REGEX "^#include <${CMAKE_MATCH_1}")
        string(FIND ${source} ${home} at)
        if(libraries AND NOT at EQUAL 0)
            complain("${source} -> ${libraries}")
        endif()
    endforeach()
endforeach()
if(broken)
    list(JOIN broken "\n  " text)
    message(FATAL_ERROR "Includes against the direction:\n  ${text}")
endif()
