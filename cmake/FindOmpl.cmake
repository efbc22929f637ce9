# Debian's ompl package names Boost libraries that libompl-dev does not install: finds header and library itself. Target: Ompl::ompl.
find_path(OMPL_INCLUDE_DIR ompl/base/SpaceInformation.h PATH_SUFFIXES ompl-1.5 ompl-1.6)
find_library(OMPL_LIBRARY ompl)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Ompl REQUIRED_VARS OMPL_LIBRARY OMPL_INCLUDE_DIR)
if(Ompl_FOUND AND NOT TARGET Ompl::ompl)
  add_library(Ompl::ompl UNKNOWN IMPORTED)
  set_target_properties(Ompl::ompl PROPERTIES IMPORTED_LOCATION ${OMPL_LIBRARY} INTERFACE_INCLUDE_DIRECTORIES ${OMPL_INCLUDE_DIR})
endif()
