# What ESP-IDF's build does with a component, as a plain library.
set(COMPONENT_LIB component)
set(IDF_TARGET esp32c3)
function(idf_component_register)
    cmake_parse_arguments(with "" "" "SRCS;INCLUDE_DIRS" ${ARGN})
    add_library(component STATIC ${with_SRCS})
    target_include_directories(component PUBLIC ${with_INCLUDE_DIRS})
endfunction()
