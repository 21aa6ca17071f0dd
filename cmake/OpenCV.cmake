# OpenCV's core, imgproc and video only. Debian ships OpenCVConfig.cmake in the 700 MB libopencv-dev, not in the small
# packages that we need, so the libraries are looked up directly; a full installation is found just as well.
find_path(EVO_OPENCV_INCLUDE_DIR opencv2/imgproc.hpp PATH_SUFFIXES opencv4 REQUIRED)
find_library(EVO_OPENCV_CORE opencv_core REQUIRED)
find_library(EVO_OPENCV_IMGPROC opencv_imgproc REQUIRED)
find_library(EVO_OPENCV_VIDEO opencv_video REQUIRED)
mark_as_advanced(EVO_OPENCV_INCLUDE_DIR EVO_OPENCV_CORE EVO_OPENCV_IMGPROC EVO_OPENCV_VIDEO)
add_library(evo_opencv INTERFACE)
target_include_directories(evo_opencv SYSTEM INTERFACE ${EVO_OPENCV_INCLUDE_DIR})
target_link_libraries(evo_opencv INTERFACE ${EVO_OPENCV_VIDEO} ${EVO_OPENCV_IMGPROC} ${EVO_OPENCV_CORE})
