# Shapes, and what operations do to them.
set(grammar_shapes_sources
  component_shapes.cpp components.cpp shape_envelope.cpp extrude.cpp flat_face.cpp initial_shape.cpp
  inner_rectangle.cpp insert.cpp loose_edges.cpp shape_materials.cpp measure.cpp mesh_cut.cpp mesh_operations.cpp
  mesh_tools.cpp mesh_triangles.cpp normals.cpp offset.cpp operations.cpp plan_skeleton.cpp
  raise_operations.cpp roofs.cpp scatter.cpp scope.cpp scope_operations.cpp selectors.cpp setback.cpp
  split.cpp split_sizes.cpp split_uv.cpp occlusion.cpp tag_operations.cpp uv_operations.cpp)
list(TRANSFORM grammar_shapes_sources PREPEND shapes/)
