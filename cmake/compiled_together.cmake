# Made by cmake/compiled_together.py, which says how and why: sources that are compiled as one, by target. A source that
# stands nowhere is compiled alone. Does a name of yours collide with one of another source? Take yours out.
blockrand_compile_together(base
  sha256.cpp portable_math.cpp parallel.cpp progress.cpp publish.cpp toml_file.cpp text.cpp markup.cpp option.cpp)
blockrand_compile_together(georef
  crs.cpp crs_facts.cpp frames.cpp projection.cpp round_trip.cpp tile_frame.cpp tiles.cpp proj_transform.cpp)
blockrand_compile_together(geometry
  box_index.cpp polygon_measures.cpp weighted_skeleton.cpp weighted_sweep_events.cpp weighted_sweep_faces.cpp
  weighted_sweep_input.cpp roof_surfaces.cpp ring_defects.cpp solid_builder.cpp plan_shape.cpp wall_segment.cpp)
blockrand_compile_together(geometry
  check_solid.cpp valid_polygon.cpp even_odd.cpp slivers.cpp noded_lines.cpp segment_grid.cpp triangle_conflicts.cpp)
blockrand_compile_together(importers_osm
  accounts.cpp area_assembly.cpp bzip2_stream.cpp colour_names.cpp construction_date.cpp osm_features.cpp osm_file.cpp
  raw_data.cpp read_extract.cpp text_cleaner.cpp)
blockrand_compile_together(importers_osm
  attributes.cpp equal_outlines.cpp interest.cpp pbf_blobs.cpp tag_values.cpp)
blockrand_compile_together(importers_elevation
  terrain.cpp bilinear.cpp)
blockrand_compile_together(importers_reference
  axes.cpp citygml.cpp citygml_parser.cpp cityjson_geometry.cpp coordinate_text.cpp file_bytes.cpp footprints.cpp
  gltf.cpp gltf_file.cpp gltf_scene.cpp height_words.cpp links.cpp)
blockrand_compile_together(importers_reference
  citygml_starts.cpp cityjson.cpp cityjson_objects.cpp gltf_table.cpp polygons.cpp reference_crs.cpp reference_model.cpp
  tileset_tree.cpp affine_transform.cpp)
blockrand_compile_together(roofs
  build_roof.cpp roof_pitch.cpp lined_roofs.cpp simple_roofs.cpp apex_roofs.cpp profile_roofs.cpp wing_ends.cpp
  roof_sides.cpp roof_outline.cpp caps.cpp)
blockrand_compile_together(roofs
  skeleton_roofs.cpp eaves_lines.cpp plan_cells.cpp overhangs.cpp cut_cells.cpp firewalls.cpp roof_slopes.cpp
  element_layout.cpp dormer_bodies.cpp dormers.cpp roof_windows.cpp)
blockrand_compile_together(roofs
  parapets.cpp gables.cpp gable_outline.cpp cross_gables.cpp chimneys.cpp chimney_places.cpp)
blockrand_compile_together(elements
  flat_shapes.cpp mesh_builder.cpp profile.cpp profile_library.cpp sweep.cpp opening_shape.cpp opening_edges.cpp
  parameters.cpp kinds.cpp trim.cpp joinery.cpp courses.cpp)
blockrand_compile_together(elements
  windows.cpp doors.cpp bays.cpp balconies.cpp corner_stones.cpp make_element.cpp)
blockrand_compile_together(classify
  catalogue.cpp classify.cpp evidence_model.cpp ground_floor.cpp votes.cpp)
blockrand_compile_together(classify
  non_houses.cpp tag_features.cpp)
blockrand_compile_together(districts
  rule_set.cpp read_rule_set.cpp rule_checks.cpp assign.cpp presets.cpp)
blockrand_compile_together(grammar
  language/bilke_import.cpp language/check.cpp language/check_rules.cpp language/check_sizes.cpp
  language/check_styles.cpp language/check_types.cpp language/file_search.cpp language/function_names.cpp
  language/lexer.cpp language/parse_declarations.cpp language/source.cpp language/value_text.cpp)
blockrand_compile_together(grammar
  language/known_names.cpp language/operation_names.cpp language/parse_expressions.cpp language/parse_successors.cpp
  language/parser_state.cpp language/program.cpp language/resolve_names.cpp language/types.cpp shapes/mesh_triangles.cpp)
blockrand_compile_together(grammar
  language/other_names.cpp shapes/component_shapes.cpp shapes/components.cpp shapes/shape_envelope.cpp
  shapes/extrude.cpp shapes/flat_face.cpp shapes/initial_shape.cpp shapes/inner_rectangle.cpp shapes/insert.cpp
  shapes/shape_materials.cpp shapes/normals.cpp)
blockrand_compile_together(grammar
  shapes/loose_edges.cpp shapes/mesh_cut.cpp shapes/mesh_operations.cpp shapes/mesh_tools.cpp shapes/offset.cpp
  shapes/operations.cpp shapes/plan_skeleton.cpp shapes/raise_operations.cpp shapes/roofs.cpp shapes/scope.cpp
  shapes/setback.cpp shapes/split_uv.cpp)
blockrand_compile_together(grammar
  shapes/scatter.cpp shapes/scope_operations.cpp shapes/selectors.cpp shapes/split.cpp shapes/split_sizes.cpp
  shapes/tag_operations.cpp shapes/uv_operations.cpp evaluation/asset_files.cpp)
blockrand_compile_together(grammar
  evaluation/derive_blocks.cpp evaluation/derive_steps.cpp evaluation/evaluate.cpp
  evaluation/evaluate_shape_functions.cpp evaluation/functions.cpp evaluation/functions_arrays.cpp
  evaluation/functions_colour.cpp evaluation/functions_conversion.cpp evaluation/functions_files.cpp
  evaluation/functions_maths.cpp evaluation/pattern.cpp)
blockrand_compile_together(grammar
  evaluation/functions_text.cpp evaluation/operators.cpp)
blockrand_compile_together(picture
  scene.cpp camera.cpp png.cpp palette.cpp view.cpp depth_map.cpp light.cpp render.cpp plan.cpp building_plan.cpp
  lettering.cpp)
blockrand_compile_together(footprints
  area.cpp footprint_store.cpp load.cpp repair_extract.cpp roof_lines.cpp terrace_rows.cpp shard.cpp)
blockrand_compile_together(repair
  arcs.cpp contacts.cpp nested_outlines.cpp ring_frames.cpp kept_nodes.cpp options.cpp repair_terrace_row.cpp
  shared_walls.cpp square_system.cpp)
blockrand_compile_together(repair
  clean_ring.cpp directions.cpp ground_overlaps.cpp terrace_graph.cpp terrace_vertices.cpp wall_lines.cpp)
blockrand_compile_together(repair
  parts.cpp terrace_noise.cpp terrace_records.cpp square.cpp)
blockrand_compile_together(context
  address_points.cpp block_figures.cpp cells.cpp context_extract.cpp wall_contacts.cpp wall_samples.cpp wall_view.cpp
  wall_segments.cpp ground.cpp height_reference.cpp point_owner.cpp street_front.cpp)
blockrand_compile_together(context
  blocks.cpp street_network.cpp vicinity_finder.cpp tagged_neighbours.cpp wall_points.cpp)
blockrand_compile_together(evidence
  building_facts.cpp style_values.cpp)
blockrand_compile_together(attributes
  area_set.cpp defaults.cpp options.cpp overrides.cpp read_overrides.cpp roof_edges.cpp rule_sets.cpp
  tagged_buildings.cpp)
blockrand_compile_together(masses
  envelope.cpp mass.cpp part_overlaps.cpp roofscape.cpp)
blockrand_compile_together(facades
  element_library.cpp facade_context.cpp facade_segments.cpp facades.cpp grammar_library.cpp opening_blocks.cpp
  opening_proof.cpp openings.cpp outlines.cpp passages.cpp roof_installations.cpp wall_corners.cpp)
blockrand_compile_together(outputs
  all_outputs.cpp citygml/citygml_output.cpp citygml/citygml_writer.cpp citygml/codes.cpp citygml/geometry_text.cpp
  cityjson/cityjson_output.cpp cityjson/detail_text.cpp cityjson/vertex_table.cpp explain/detail_text.cpp
  explain/explain_output.cpp explain/explanation.cpp)
blockrand_compile_together(outputs
  cityjson/object_text.cpp explain/find_explanation.cpp explain/situation_text.cpp wall_segment_ids.cpp
  geopackage/columns.cpp geopackage/context_columns.cpp geopackage/context_layers.cpp geopackage/geopackage_output.cpp
  geopackage/qgis_styles.cpp)
blockrand_compile_together(outputs
  cityjson/template_table.cpp explain/style_text.cpp geopackage/geopackage_writer.cpp gltf/building_table.cpp
  gltf/element_geometry.cpp gltf/glb_document.cpp gltf/glb_writer.cpp gltf/gltf_output.cpp gltf/instance_writer.cpp
  gltf/material.cpp gltf/mesh_buffers.cpp gltf/meshopt.cpp)
blockrand_compile_together(outputs
  gltf/property_table.cpp gltf/stored_element.cpp gzip.cpp material_classes.cpp placed_element.cpp options.cpp
  output.cpp plan/plan_picture.cpp report/page_assets.cpp report/pictures.cpp report/report_issues.cpp)
blockrand_compile_together(outputs
  gltf/triangle_glb.cpp report/report_json_output.cpp report/report_map.cpp report/report_output.cpp
  report/report_page.cpp report/report_sections.cpp report/report_styles.cpp report/report_tile.cpp statistics.cpp
  number_text.cpp tileset/tileset.cpp)
blockrand_compile_together(run
  account.cpp build.cpp build_inputs.cpp configuration.cpp district_survey.cpp options.cpp outcome.cpp
  prepare_extract.cpp region_facts.cpp tile_choice.cpp tile_stages.cpp whole_model.cpp)
blockrand_compile_together(validate
  attribute_names.cpp build_record.cpp citygml_reader.cpp citygml_join.cpp citygml_names.cpp citygml_schema.cpp
  cityjson_reader.cpp cityjson_templates.cpp format_agreement.cpp formats.cpp detail_check.cpp explanations.cpp)
blockrand_compile_together(validate
  cityjson_object_reader.cpp bytes_of_file.cpp geopackage.cpp geopackage_context.cpp geopackage_rules.cpp glb.cpp
  glb_container.cpp meshopt_view.cpp options.cpp places.cpp)
blockrand_compile_together(validate
  part_overlap_check.cpp positions.cpp property_table_reader.cpp report_check.cpp sqlite_file.cpp findings_summary.cpp
  tile_check.cpp validate_build.cpp)
blockrand_compile_together(validate
  placed_elements.cpp findings_page.cpp)
blockrand_compile_together(compare
  baseline.cpp body.cpp compare.cpp cover.cpp face_triangles.cpp facade_measures.cpp facade_pairs.cpp heat_mesh.cpp
  matching.cpp measure_names.cpp options.cpp report_assets.cpp)
blockrand_compile_together(compare
  facade_planes.cpp opening_grid.cpp report_numbers.cpp report_pictures.cpp report_places.cpp)
blockrand_compile_together(compare
  facade_agreement.cpp read_city.cpp report_plan.cpp report_svg.cpp report_text.cpp report_words.cpp
  roofs_from_above.cpp summary.cpp)
blockrand_compile_together(compare
  comparison_sections.cpp surfaces.cpp union_area.cpp)
blockrand_compile_together(settings
  options.cpp command_options.cpp config_file.cpp command_line.cpp command_text.cpp reference.cpp manual.cpp)
blockrand_compile_together(cli
  build_command.cpp build_report.cpp command.cpp compare_command.cpp configs_folder.cpp districts_command.cpp errors.cpp
  explain_command.cpp grammar_run.cpp help.cpp info_command.cpp signals.cpp)
blockrand_compile_together(cli
  explain_style.cpp grammar_command.cpp validate_command.cpp)
blockrand_compile_together(cli
  extract_summary.cpp rule_files.cpp)
