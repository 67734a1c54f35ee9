# The warnings that sources are held to, in this one place: slabcast_warnings(TARGET) sets them, and
# tests/portability.sh is given them for other compilers.
option(SLABCAST_WERROR "Warnings are errors" OFF)

set(SLABCAST_WARNINGS -Wall -Wextra -Wshadow)
# Of what a number may lose where it is converted: for the libraries that others build upon.
set(SLABCAST_CONVERSIONS -Wconversion -Wno-sign-conversion)
# Desc structs are written with designated initialisers, and leave out what keeps its default.
set(SLABCAST_NO_WARNINGS -Wno-missing-field-initializers)

# slabcast_warnings(TARGET [STRICT]): STRICT looks at conversions, too.
function(slabcast_warnings target)
    cmake_parse_arguments(PARSE_ARGV 1 is "STRICT" "" "")
    target_compile_options(${target} PRIVATE ${SLABCAST_WARNINGS})
    if(is_STRICT)
        target_compile_options(${target} PRIVATE ${SLABCAST_CONVERSIONS})
    endif()
    target_compile_options(${target} PRIVATE ${SLABCAST_NO_WARNINGS})
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND (is_STRICT OR SLABCAST_WERROR))
        target_compile_options(${target} PRIVATE -Wno-restrict) # false alarms in g++ 12, bug 105329
    endif()
    if(SLABCAST_WERROR)
        target_compile_options(${target} PRIVATE -Werror)
    endif()
endfunction()
