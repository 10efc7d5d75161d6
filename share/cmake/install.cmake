# `cmake --install` and the Debian package.
#
# Decks name their tables relative to themselves (../../share/reference/...), so the folders that belong
# together keep their places, below share/sphgeo.

include(GNUInstallDirs)

set(data ${CMAKE_INSTALL_DATADIR}/sphgeo)
install(TARGETS sphgeo RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(DIRECTORY decks schemas DESTINATION ${data})
install(DIRECTORY share/reference share/assets share/plot share/paraview share/validation DESTINATION ${data}/share
  USE_SOURCE_PERMISSIONS PATTERN __pycache__ EXCLUDE)
install(FILES share/doc/reference.md README.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright)
install(DIRECTORY man/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 FILES_MATCHING PATTERN "*.1")
install(FILES share/completion/sphgeo.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME sphgeo)
install(FILES share/completion/_sphgeo DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions)

# `cpack -G DEB` in the build folder. A package for other machines wants the preset "portable".
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME sphgeo)
set(CPACK_PACKAGE_VENDOR "the authors of sphgeo")
set(CPACK_PACKAGE_CONTACT "the authors of sphgeo <sphgeo@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "particle simulation of water, soil, rock and structures")
set(CPACK_PACKAGE_DESCRIPTION "A smoothed particle hydrodynamics (SPH) program: it reads a scene from a YAML deck and writes
frames for ParaView, curves as CSV, and whether the deck's expectations were met.")
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "paraview, python3-matplotlib")
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
include(CPack)
