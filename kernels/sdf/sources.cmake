# Sources of the signed distance evaluators. The ISA files carry their own flags; the choice falls at run time.
set(SCREE_SDF_SOURCES sdf/mlp.cpp)
set(SCREE_SDF_HEADERS sdf/analytic.h sdf/analytic.inl.h sdf/superellipsoid.h sdf/mlp.h sdf/sdf_batch.h)
