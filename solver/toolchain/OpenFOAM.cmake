# SPDX-License-Identifier: GPL-3.0-or-later
#
# OpenFOAM as CMake targets, from an ordinary installation or from Debian's packaged libraries plus prepared headers.
#
#     include(toolchain/OpenFOAM.cmake)                        # in solver/CMakeLists.txt
#     if(NOT OpenFOAM_FOUND)
#         return()                                             # the reason has been printed
#     endif()
#     add_executable(himFoam himFoam/himFoam.C)
#     target_link_libraries(himFoam PRIVATE OpenFOAM::finiteVolume OpenFOAM::lagrangian dem_coupling)
#
# Targets    OpenFOAM::<library> for every line of openfoam_libraries.txt; each brings its headers (as system headers, so
#            that our warnings do not fire in them), OpenFOAM's compile definitions and the libraries it needs.
# Sets       OpenFOAM_FOUND, OpenFOAM_API (1912, ...), OpenFOAM_TREE (the folder that holds src/).
# Headers    cmake -DHIMFOAM_OPENFOAM_HEADERS=<folder>, a folder that holds src/<library>/lnInclude,
#            else $WM_PROJECT_DIR, when it holds src/ and $FOAM_LIBBIN its libraries (an ordinary installation),
#            else build/toolchain/openfoam, made by prepare_openfoam.
# Libraries  $FOAM_LIBBIN/$FOAM_MPI and $FOAM_LIBBIN where these are set, else (and for prepared headers) the system's.
# To use one more library, add its line to openfoam_libraries.txt and run Allrun (or prepare_openfoam) again.

set(HIMFOAM_OPENFOAM_HEADERS "" CACHE PATH "Folder that holds OpenFOAM's src/<library>/lnInclude (empty: look for it)")
set(OpenFOAM_FOUND FALSE)
set(OpenFOAM_PREPARED_TREE ${CMAKE_BINARY_DIR}/toolchain/openfoam)

function(openfoam_find_tree result)
    if(HIMFOAM_OPENFOAM_HEADERS)
        set(candidates ${HIMFOAM_OPENFOAM_HEADERS})
    else()
        set(candidates ${OpenFOAM_PREPARED_TREE})
        if(EXISTS $ENV{FOAM_LIBBIN}/libOpenFOAM.so)
            list(PREPEND candidates $ENV{WM_PROJECT_DIR})
        endif()
    endif()
    foreach(candidate IN LISTS candidates)
        if(EXISTS ${candidate}/src/OpenFOAM/lnInclude/argList.H)
            set(${result} ${candidate} PARENT_SCOPE)
            return()
        endif()
    endforeach()
    set(${result} "" PARENT_SCOPE)
endfunction()

# The API number of a tree, from META-INFO/api-info ("api=1912").
function(openfoam_read_api tree result)
    set(api "")
    if(EXISTS ${tree}/META-INFO/api-info)
        file(STRINGS ${tree}/META-INFO/api-info line REGEX "^api=")
        string(REGEX REPLACE "^api=" "" api "${line}")
    endif()
    set(${result} "${api}" PARENT_SCOPE)
endfunction()

# Full path of a library. The answer is not cached, because the environment may change between two configurations of one
# build folder. Either the installation's folders are searched or the system's: two OpenFOAM versions must not be mixed.
function(openfoam_find_library name result)
    unset(found)
    if(DEFINED ENV{FOAM_LIBBIN} AND NOT OpenFOAM_TREE STREQUAL OpenFOAM_PREPARED_TREE)
        find_library(found NAMES ${name} NO_CACHE NO_DEFAULT_PATH
            PATHS $ENV{FOAM_LIBBIN}/$ENV{FOAM_MPI} $ENV{FOAM_LIBBIN})
    else()
        find_library(found NAMES ${name} NO_CACHE)
    endif()
    set(${result} "${found}" PARENT_SCOPE)
endfunction()

# OpenFOAM::common: definitions, the Pstream library and the linker option that keeps libraries which only register
# types at load time.
function(openfoam_add_common tree api)
    openfoam_find_library(Pstream pstream)
    set(precision DP)
    if(DEFINED ENV{WM_PRECISION_OPTION})
        set(precision $ENV{WM_PRECISION_OPTION})
    endif()
    set(labelSize 32)
    if(DEFINED ENV{WM_LABEL_SIZE})
        set(labelSize $ENV{WM_LABEL_SIZE})
    endif()
    add_library(OpenFOAM::common INTERFACE IMPORTED GLOBAL)
    target_compile_definitions(OpenFOAM::common INTERFACE
        OPENFOAM=${api} WM_${precision} WM_LABEL_SIZE=${labelSize} NoRepository OMPI_SKIP_MPICXX)
    target_include_directories(OpenFOAM::common SYSTEM INTERFACE ${tree}/src/OSspecific/POSIX/lnInclude)
    target_link_options(OpenFOAM::common INTERFACE LINKER:--no-as-needed)
    target_link_libraries(OpenFOAM::common INTERFACE ${pstream} ${CMAKE_DL_LIBS})
endfunction()

# One target for one line of openfoam_libraries.txt: folder, library, needed targets.
function(openfoam_add_library tree folder library)
    openfoam_find_library(${library} path)
    if(NOT path OR NOT EXISTS ${tree}/src/${folder}/lnInclude)
        message(STATUS "OpenFOAM::${library} is not available: ${tree}/src/${folder}/lnInclude or lib${library}.so missing")
        return()
    endif()
    add_library(OpenFOAM::${library} INTERFACE IMPORTED GLOBAL)
    target_include_directories(OpenFOAM::${library} SYSTEM INTERFACE ${tree}/src/${folder}/lnInclude)
    list(TRANSFORM ARGN PREPEND OpenFOAM:: OUTPUT_VARIABLE needs)
    target_link_libraries(OpenFOAM::${library} INTERFACE ${path} ${needs} OpenFOAM::common)
endfunction()

openfoam_find_tree(OpenFOAM_TREE)
openfoam_find_library(OpenFOAM OpenFOAM_LIBRARY)
if(NOT OpenFOAM_TREE OR NOT OpenFOAM_LIBRARY)
    message(STATUS "OpenFOAM headers or libraries not found, so solver/ is left out. Prepare them with "
        "`./Allrun -build-only`, or name a folder: cmake -DHIMFOAM_OPENFOAM_HEADERS=<folder that holds src/>")
    return()
endif()
openfoam_read_api(${OpenFOAM_TREE} OpenFOAM_API)
if(NOT OpenFOAM_API)
    message(FATAL_ERROR "${OpenFOAM_TREE}/META-INFO/api-info does not give the OpenFOAM version (api=NNNN).")
endif()

openfoam_add_common(${OpenFOAM_TREE} ${OpenFOAM_API})
set(OpenFOAM_LIST ${CMAKE_CURRENT_LIST_DIR}/openfoam_libraries.txt)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${OpenFOAM_LIST})
file(STRINGS ${OpenFOAM_LIST} lines REGEX "^[^#]")
foreach(line IN LISTS lines)
    separate_arguments(words UNIX_COMMAND "${line}")
    openfoam_add_library(${OpenFOAM_TREE} ${words})
endforeach()
set(OpenFOAM_FOUND TRUE)
message(STATUS "OpenFOAM ${OpenFOAM_API}: headers ${OpenFOAM_TREE}/src, library ${OpenFOAM_LIBRARY}")
