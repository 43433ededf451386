# `cmake --install`, and two Debian packages by CPack: orcartd, what runs on a cart, and orcart, the tools.
set(CPACK_PACKAGE_NAME orcart)
set(CPACK_PACKAGE_CONTACT "the orcart project <orcart@localhost>")
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_GENERATOR DEB)
set(CPACK_COMPONENTS_ALL cart tools)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_CART_PACKAGE_NAME orcartd)
set(CPACK_COMPONENT_CART_DESCRIPTION "endoscope-painting cart
 Tracks an endoscope, takes its pictures at a pedal and paints them onto the patient's surface, on a kiosk of its own.
 Research use; not a medical device.")
# Mesa is opened at run time, so no shared library's dependency names it; nor does any name the panel's font.
set(CPACK_DEBIAN_CART_PACKAGE_DEPENDS "libegl-mesa0, libgl1-mesa-dri, fonts-dejavu-core")
set(CPACK_DEBIAN_CART_PACKAGE_RECOMMENDS "systemd, udev, linux-image-rt-amd64")
set(CPACK_DEBIAN_CART_PACKAGE_CONTROL_EXTRA "${CMAKE_SOURCE_DIR}/board/cart/postinst;${CMAKE_BINARY_DIR}/conffiles")
set(CPACK_DEBIAN_TOOLS_PACKAGE_NAME orcart)
set(CPACK_COMPONENT_TOOLS_DESCRIPTION "tools of the endoscope-painting cart
 Surfaces, calibration, registration, offline painting, reports and an emulated tracker.
 Research use; not a medical device.")
# The demo's files, which `orcart evaluate` takes where it is told no others.
set(CPACK_DEBIAN_TOOLS_PACKAGE_RECOMMENDS "orcartd")
file(WRITE ${CMAKE_BINARY_DIR}/conffiles "/etc/default/orcart\n")
file(CHMOD ${CMAKE_BINARY_DIR}/conffiles PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ)

# An installed demo keeps its movies where every user may write.
file(READ ${CMAKE_SOURCE_DIR}/share/carts/demo.toml demo_cart)
string(REPLACE "../../build/movies" "/var/tmp/orcart-movies" demo_cart "${demo_cart}")
file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/share/demo.toml CONTENT "${demo_cart}" @ONLY)

set(cart_files ${CMAKE_SOURCE_DIR}/board/cart)
install(TARGETS orcartd RUNTIME COMPONENT cart)
install(TARGETS orcart RUNTIME COMPONENT tools)
install(DIRECTORY ${CMAKE_SOURCE_DIR}/share/ DESTINATION share/orcart COMPONENT cart PATTERN demo.toml EXCLUDE)
install(FILES ${CMAKE_BINARY_DIR}/share/demo.toml DESTINATION share/orcart/carts COMPONENT cart)
install(FILES ${cart_files}/orcart.service DESTINATION lib/systemd/system COMPONENT cart)
install(FILES ${cart_files}/70-orcart.rules DESTINATION lib/udev/rules.d COMPONENT cart)
install(FILES ${cart_files}/orcart.sysusers DESTINATION lib/sysusers.d RENAME orcart.conf COMPONENT cart)
install(FILES ${cart_files}/kernel-command-line.cfg DESTINATION share/orcart/grub COMPONENT cart)
install(FILES ${cart_files}/orcart.default DESTINATION /etc/default RENAME orcart COMPONENT cart)
install(DIRECTORY DESTINATION /etc/orcart COMPONENT cart)
install(FILES ${cart_files}/README.md ${CMAKE_SOURCE_DIR}/CHANGELOG.md DESTINATION share/doc/orcartd COMPONENT cart)
install(FILES ${CMAKE_SOURCE_DIR}/LICENSE DESTINATION share/doc/orcartd RENAME copyright COMPONENT cart)
install(FILES ${CMAKE_SOURCE_DIR}/LICENSE DESTINATION share/doc/orcart RENAME copyright COMPONENT tools)
include(CPack)
