add_compile_options(-Wall -Wextra -Wno-psabi)
if(EMSCRIPTEN)
  # -msse4.1 switches on Eigen's SSE path, which Emscripten maps to WASM SIMD.
  add_compile_options(-fexceptions -msimd128 -msse4.1)
  # A usual scan needs some 70 MB, so that memory begins with a little more and need not grow for it.
  add_link_options(-fexceptions -msimd128 -sALLOW_MEMORY_GROWTH -sINITIAL_MEMORY=96MB -sMAXIMUM_MEMORY=4GB)
  if(VITRUVIAN_THREADS)
    add_compile_options(-pthread)
    add_link_options(-pthread -Wno-pthreads-mem-growth)
  endif()
elseif(VITRUVIAN_AVX2 AND CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  add_compile_options(-march=x86-64-v3)
endif()
if(VITRUVIAN_SANITIZE)
  add_compile_options(-fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
  add_link_options(-fsanitize=address,undefined)
endif()

# A precompiled header of what nearly every file includes. A compiler cache does better by itself and cannot cache such files.
if(CMAKE_CXX_COMPILER_LAUNCHER)
  set(precompile OFF)
else()
  set(precompile ON)
endif()
option(VITRUVIAN_PRECOMPILE "Precompile Eigen's and the standard library's headers" ${precompile})

# vitruvian_precompile(TARGET SET LIBRARY [HEADER...]): lets TARGET use the precompiled headers, and HEADERs of LIBRARY too;
# the first target that asks makes them for all of its SET.
function(vitruvian_precompile target set library)
  if(NOT VITRUVIAN_PRECOMPILE)
    return()
  endif()
  set(name vitruvian_precompiled_${set})
  if(NOT TARGET ${name})
    file(WRITE ${CMAKE_BINARY_DIR}/${name}.cpp "")
    add_library(${name} OBJECT ${CMAKE_BINARY_DIR}/${name}.cpp)
    target_link_libraries(${name} PRIVATE third_party ${library})
    target_precompile_headers(${name} PRIVATE <Eigen/Dense> <array> <cstdint> <functional> <memory>
      <nlohmann/json.hpp> <optional> <span> <stdexcept> <string> <string_view> <utility> <vector> ${ARGN})
  endif()
  target_precompile_headers(${target} REUSE_FROM ${name})
endfunction()
