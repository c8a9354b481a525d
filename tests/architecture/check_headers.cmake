# The target check_headers compiles every header of core, api and server alone, in a file of its own that has no other
# line: one that leans on what its includers included before is found.
file(GLOB_RECURSE headers CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}
     ${PROJECT_SOURCE_DIR}/core/*.h ${PROJECT_SOURCE_DIR}/api/*.h ${PROJECT_SOURCE_DIR}/server/*.h)
set(alone)
foreach(header IN LISTS headers)
    string(REPLACE "/" "_" name ${header})
    set(file ${CMAKE_CURRENT_BINARY_DIR}/headers/${name}.cpp)
    file(CONFIGURE OUTPUT ${file} CONTENT "#include \"${header}\"\n")
    list(APPEND alone ${file})
endforeach()
add_library(check_headers OBJECT EXCLUDE_FROM_ALL ${alone})
target_link_libraries(check_headers PRIVATE lastflat_server TinyGLTF::TinyGLTF spdlog::spdlog lastflat_warnings)
set_target_properties(check_headers PROPERTIES UNITY_BUILD OFF
    CXX_COMPILER_LAUNCHER ${CMAKE_CURRENT_SOURCE_DIR}/architecture/syntax_only.sh)
