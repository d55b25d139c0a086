# Clipper 6, which comes without CMake files of its own: target polyclipping::polyclipping.
find_path(POLYCLIPPING_INCLUDE_DIR polyclipping/clipper.hpp)
find_library(POLYCLIPPING_LIBRARY polyclipping)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Polyclipping REQUIRED_VARS POLYCLIPPING_LIBRARY POLYCLIPPING_INCLUDE_DIR)
mark_as_advanced(POLYCLIPPING_INCLUDE_DIR POLYCLIPPING_LIBRARY)
if(Polyclipping_FOUND AND NOT TARGET polyclipping::polyclipping)
  add_library(polyclipping::polyclipping UNKNOWN IMPORTED)
  set_target_properties(polyclipping::polyclipping PROPERTIES
    IMPORTED_LOCATION "${POLYCLIPPING_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${POLYCLIPPING_INCLUDE_DIR}")
endif()
