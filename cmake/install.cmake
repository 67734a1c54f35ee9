# What `cmake --install` lays down: one static library, its headers and its export file per component.
# Consumers write find_package(Slabcast COMPONENTS egl json io) and link Slabcast::core, Slabcast::egl,
# Slabcast::json, Slabcast::io.
include(CMakePackageConfigHelpers)

set(packageDir ${CMAKE_INSTALL_LIBDIR}/cmake/Slabcast)
set(headerRoot ${CMAKE_INSTALL_INCLUDEDIR}/slabcast)
# What applications include; with it comes what these name.
set(headers_core core/slabcast.h)
set(headers_egl platform/egl/egl_context.h)
set(headers_json platform/json/transfer_json.h)
set(headers_io platform/io/load_volume.h platform/io/save_image.h platform/io/save_nrrd.h)

foreach(component IN ITEMS core egl json io)
    if(NOT TARGET slabcast_${component})
        continue()
    endif()
    install(TARGETS slabcast_${component} EXPORT Slabcast_${component}
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
    install(EXPORT Slabcast_${component} NAMESPACE Slabcast::
        FILE Slabcast_${component}.cmake DESTINATION ${packageDir})
    install(CODE "
        set(SOURCE \"${PROJECT_SOURCE_DIR}\")
        set(INCLUDE_DIR \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${headerRoot}\")
        set(HEADERS ${headers_${component}})
        include(\"${PROJECT_SOURCE_DIR}/cmake/install_headers.cmake\")")
endforeach()

if(TARGET slabcast_images)
    install(TARGETS slabcast_images slabcast_dicom slabcast_read
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/slabcast RUNTIME DESTINATION ${CMAKE_INSTALL_LIBDIR}/slabcast)
endif()
if(TARGET slabcast)
    install(TARGETS slabcast RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
    install(DIRECTORY perf/pages/ DESTINATION ${CMAKE_INSTALL_DATADIR}/slabcast/perf USE_SOURCE_PERMISSIONS
        FILES_MATCHING PATTERN "*.py" PATTERN "*.css" PATTERN __pycache__ EXCLUDE)
endif()
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})

configure_package_config_file(cmake/SlabcastConfig.cmake.in ${PROJECT_BINARY_DIR}/SlabcastConfig.cmake
    INSTALL_DESTINATION ${packageDir} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/SlabcastConfigVersion.cmake
    COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/SlabcastConfig.cmake ${PROJECT_BINARY_DIR}/SlabcastConfigVersion.cmake
    DESTINATION ${packageDir})
