# The two parts of OpenCV that draw. Debian ships OpenCVConfig.cmake only with libopencv-dev (755 MB with its dependencies);
# libopencv-core-dev and libopencv-imgproc-dev are 132 MB, so they are found by name. Used by the build and by the installed package.
find_path(LOBEFIT_OPENCV_INCLUDE_DIR opencv2/imgproc.hpp PATH_SUFFIXES opencv4 REQUIRED)
foreach(part core imgproc)
  if(NOT TARGET lobefit::opencv_${part})
    find_library(LOBEFIT_OPENCV_${part} opencv_${part} REQUIRED)
    add_library(lobefit::opencv_${part} UNKNOWN IMPORTED)
    set_target_properties(lobefit::opencv_${part} PROPERTIES IMPORTED_LOCATION ${LOBEFIT_OPENCV_${part}}
      INTERFACE_SYSTEM_INCLUDE_DIRECTORIES ${LOBEFIT_OPENCV_INCLUDE_DIR}
      INTERFACE_INCLUDE_DIRECTORIES ${LOBEFIT_OPENCV_INCLUDE_DIR})
  endif()
endforeach()
