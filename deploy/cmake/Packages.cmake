# What `cmake --install` puts where, by component, and how CPack makes four Debian packages of it (deploy/packages does all steps):
# tractus-server, tractus-station, tractus-tools, tractus-web.

include(GNUInstallDirs)
set(TRACTUS_MADE ${CMAKE_BINARY_DIR}/made CACHE PATH "Manual pages, component lists and third-party licences (deploy/packages)")

function(tractus_install component)  # tractus_install(component PROGRAM...)  programs with manual pages, completion, licence
  install(TARGETS ${ARGN} RUNTIME COMPONENT ${component})
  foreach(program IN LISTS ARGN)
    install(DIRECTORY ${TRACTUS_MADE}/man/${program}/ TYPE MAN OPTIONAL COMPONENT ${component})
    install(FILES ${CMAKE_SOURCE_DIR}/deploy/debian/completion RENAME ${program}
      DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT ${component})
  endforeach()
endfunction()

function(tractus_document component)
  set(folder ${CMAKE_INSTALL_DATADIR}/doc/tractus-${component})
  install(FILES ${TRACTUS_MADE}/${component}/copyright ${TRACTUS_MADE}/${component}/sbom.spdx.json ${TRACTUS_MADE}/changelog.gz
    DESTINATION ${folder} OPTIONAL COMPONENT ${component})
endfunction()

tractus_install(server tractus-server)
tractus_install(station tractus-station tractus-rig)
tractus_install(tools tractus)
if(TARGET tractus_model)
  install(TARGETS tractus_model tractus_model_formulas LIBRARY DESTINATION lib/tractus COMPONENT tools)  # beside bin, where `tractus fmu` looks
  install(FILES ${CMAKE_BINARY_DIR}/lib/tractus/licences.txt DESTINATION lib/tractus COMPONENT tools)
endif()
foreach(component server station tools web)
  tractus_document(${component})
endforeach()
install(DIRECTORY web/dist/ DESTINATION ${CMAKE_INSTALL_DATADIR}/tractus/web COMPONENT web)

set(debian ${CMAKE_SOURCE_DIR}/deploy/debian)
foreach(component server station)
  install(FILES ${debian}/${component}/${component}.conf DESTINATION /etc/tractus COMPONENT ${component})
  install(FILES ${debian}/${component}/sysusers.conf RENAME tractus-${component}.conf DESTINATION lib/sysusers.d COMPONENT ${component})
  install(FILES ${debian}/${component}/tmpfiles.conf RENAME tractus-${component}.conf DESTINATION lib/tmpfiles.d COMPONENT ${component})
endforeach()
install(FILES deploy/systemd/tractus-server.service deploy/systemd/tractus-backup.service deploy/systemd/tractus-backup.timer
  DESTINATION lib/systemd/system COMPONENT server)
install(FILES deploy/systemd/tractus-kiosk.service DESTINATION lib/systemd/system COMPONENT station)
install(FILES deploy/udev/70-tractus.rules DESTINATION lib/udev/rules.d COMPONENT station)
install(FILES ${debian}/station/limits.conf RENAME 70-tractus.conf DESTINATION /etc/security/limits.d COMPONENT station)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME tractus)
set(CPACK_PACKAGE_CONTACT "The Tractus authors <tractus@example.org>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
if(TRACTUS_SYMBOLS)  # strips the programs and keeps their symbols as tractus-*-dbgsym, found by build id
  set(CPACK_DEBIAN_DEBUGINFO_PACKAGE ON)
else()
  set(CPACK_STRIP_FILES ON)
endif()
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL server station tools web)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(processor "\nIt needs a processor of the level ${TRACTUS_ARCH} (AVX2, 2013 or newer).")
set(CPACK_COMPONENT_SERVER_DESCRIPTION "Tractus server: cases, trials and their assessment\nTraining and assessment of pedicle-screw work at several stations.${processor}")
set(CPACK_COMPONENT_STATION_DESCRIPTION "Tractus station: haptic training of pedicle-screw work\nForces from a CT volume at a hand device, or from layered bone at a motor rig.${processor}")
set(CPACK_COMPONENT_TOOLS_DESCRIPTION "Tractus tools: import volumes, make cases, compare models with measurements\nThe command tractus, with the model lab.${processor}")
set(CPACK_COMPONENT_WEB_DESCRIPTION "Tractus web pages\nFiles that tractus-server and a station's full-screen page serve.")
foreach(component SERVER STATION TOOLS WEB)
  string(TOLOWER tractus-${component} CPACK_DEBIAN_${component}_PACKAGE_NAME)
endforeach()
set(CPACK_DEBIAN_WEB_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_WEB_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_SERVER_PACKAGE_DEPENDS "systemd, debconf, tractus-web (= ${PROJECT_VERSION})")
set(CPACK_DEBIAN_STATION_PACKAGE_DEPENDS "systemd, debconf, tractus-web (= ${PROJECT_VERSION})")
set(CPACK_DEBIAN_STATION_PACKAGE_SUGGESTS "cage, chromium")

# tractus_debian(component FOLDER LINKS DATA)  the scripts of a package with data: its folder, links of units that are switched on, what a
# purge deletes when it is told to
function(tractus_debian component folder links data)
  set(scripts ${CMAKE_BINARY_DIR}/debian/${component})
  configure_file(${debian}/postrm ${scripts}/postrm @ONLY)
  string(TOUPPER CPACK_DEBIAN_${component}_PACKAGE_CONTROL_EXTRA extra)
  set(${extra} ${debian}/${component}/postinst ${debian}/${component}/prerm ${debian}/${component}/templates ${debian}/${component}/conffiles
    ${scripts}/postrm PARENT_SCOPE)
endfunction()
tractus_debian(server /var/lib/tractus
  "/etc/systemd/system/*.wants/tractus-server.service /etc/systemd/system/*.wants/tractus-backup.timer" "/var/lib/tractus /etc/tractus/admin-password")
tractus_debian(station /var/lib/tractus-station "/etc/systemd/system/*.wants/tractus-kiosk.service" /var/lib/tractus-station)
include(CPack)
