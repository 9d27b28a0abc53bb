# Sources of the signed distance evaluators. The ISA files carry their own flags; the choice falls at run time.
set(SCREE_SDF_SOURCES sdf/mlp.cpp sdf/mlp_cpu.cpp sdf/mlp_cpu_generic.cpp sdf/network_image.cpp sdf/tensor_image.cpp)
set(SCREE_SDF_HEADERS sdf/analytic.h sdf/analytic.inl.h sdf/grid.h sdf/harmonics.h sdf/mesh.h sdf/revolution.h sdf/superellipsoid.h sdf/superellipsoid_foot.h sdf/mlp.h sdf/mlp_activation.h sdf/mlp_fold.h sdf/mlp_fused.h sdf/network_image.h sdf/sdf_batch.h sdf/half.h sdf/tensor_image.h sdf/tensor_layout.h sdf/tensor_tile.h sdf/tensor_warp.h)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  list(APPEND SCREE_SDF_SOURCES sdf/mlp_cpu_avx2.cpp sdf/mlp_cpu_avx512.cpp)
  set_source_files_properties(sdf/mlp_cpu_avx2.cpp PROPERTIES COMPILE_OPTIONS "-mavx2;-mfma")
  # GCC 12 warns of its own _mm512_undefined inside the intrinsics' header.
  set_source_files_properties(sdf/mlp_cpu_avx512.cpp PROPERTIES COMPILE_OPTIONS "-mavx512f;-mfma;-Wno-maybe-uninitialized")
endif()
if(SCREE_SANITIZE)  # at -O2 the instrumented, fully unrolled tiles take minutes a file to compile
  set_property(SOURCE sdf/mlp_cpu_generic.cpp sdf/mlp_cpu_avx2.cpp sdf/mlp_cpu_avx512.cpp APPEND PROPERTY COMPILE_OPTIONS "-O1")
endif()
