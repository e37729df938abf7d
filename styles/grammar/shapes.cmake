# Shapes and what operations do to them.
set(grammar_shape_sources
  scope.cpp mesh_tools.cpp loose_edges.cpp mesh_cut.cpp initial_shape.cpp split_sizes.cpp split.cpp extrude.cpp
  selectors.cpp components.cpp component_shapes.cpp scope_operations.cpp insert.cpp materials.cpp raise_operations.cpp measure.cpp
  flat_face.cpp mesh_triangles.cpp surroundings.cpp mesh_operations.cpp normals.cpp operations.cpp
  plan_skeleton.cpp roofs.cpp offset.cpp setback.cpp inner_rectangle.cpp
  uv_operations.cpp split_uv.cpp scatter.cpp tag_operations.cpp envelope.cpp)
