# Made by cmake/compiled_together.py, which says how and why: sources that are compiled as one, by target. A source that
# stands nowhere is compiled alone. Does a name of yours collide with one of another source? Take yours out.
blockrand_compile_together(base  # pipeline/base
  markup.cpp option.cpp parallel.cpp portable_math.cpp progress.cpp publish.cpp sha256.cpp text.cpp toml_file.cpp)
blockrand_compile_together(georef  # pipeline/georef
  crs.cpp crs_facts.cpp frames.cpp proj_transform.cpp projection.cpp round_trip.cpp tile_frame.cpp tiles.cpp)
blockrand_compile_together(geometry  # pipeline/geometry
  box_index.cpp noded_lines.cpp planar_faces.cpp roof_surfaces.cpp segment_grid.cpp slivers.cpp solid_builder.cpp
  valid_polygon.cpp wall_segment.cpp weighted_skeleton.cpp weighted_sweep_faces.cpp weighted_sweep_input.cpp)
blockrand_compile_together(geometry  # pipeline/geometry
  check_solid.cpp even_odd.cpp plan_shape.cpp polygon_measures.cpp ring_defects.cpp solid_overlap.cpp
  weighted_sweep_events.cpp)
blockrand_compile_together(importers_osm  # importers/osm
  accounts.cpp area_assembly.cpp bzip2_stream.cpp colour_names.cpp construction_date.cpp osm_features.cpp osm_file.cpp
  raw_data.cpp read_extract.cpp text_cleaner.cpp)
blockrand_compile_together(importers_osm  # importers/osm
  attributes.cpp equal_outlines.cpp interest.cpp pbf_blobs.cpp tag_values.cpp)
blockrand_compile_together(importers_elevation  # importers/elevation
  bilinear.cpp terrain.cpp)
blockrand_compile_together(importers_reference  # importers/reference
  affine_transform.cpp axes.cpp citygml_starts.cpp cityjson.cpp cityjson_geometry.cpp coordinate_text.cpp file_bytes.cpp
  footprints.cpp gltf.cpp gltf_file.cpp gltf_scene.cpp gltf_table.cpp height_words.cpp links.cpp polygons.cpp
  reference_model.cpp triangle_model.cpp)
blockrand_compile_together(importers_reference  # importers/reference
  citygml.cpp cityjson_objects.cpp read_model.cpp reference_crs.cpp)
blockrand_compile_together(importers_reference  # importers/reference
  citygml_parser.cpp tileset_tree.cpp)
blockrand_compile_together(roofs  # styles/roofs
  apex_roofs.cpp build_roof.cpp chimney_places.cpp cross_gables.cpp cut_cells.cpp dormer_bodies.cpp firewalls.cpp
  gable_outline.cpp gables.cpp lined_roofs.cpp parapets.cpp roof_outline.cpp roof_pitch.cpp roof_windows.cpp
  simple_roofs.cpp wing_ends.cpp)
blockrand_compile_together(roofs  # styles/roofs
  chimneys.cpp dormers.cpp profile_roofs.cpp roof_sides.cpp roof_slopes.cpp skeleton_roofs.cpp)
blockrand_compile_together(roofs  # styles/roofs
  eaves_lines.cpp overhangs.cpp plan_cells.cpp)
blockrand_compile_together(roofs  # styles/roofs
  caps.cpp element_layout.cpp)
blockrand_compile_together(elements  # styles/elements
  balconies.cpp corner_stones.cpp courses.cpp flat_shapes.cpp kinds.cpp make_kind.cpp opening_edges.cpp
  opening_shape.cpp parameters.cpp profile_library.cpp windows.cpp)
blockrand_compile_together(elements  # styles/elements
  bays.cpp doors.cpp joinery.cpp mesh_builder.cpp profile.cpp sweep.cpp trim.cpp)
blockrand_compile_together(elements  # styles/elements
  check_element_file.cpp element_catalogue.cpp element_file.cpp expression.cpp read_piece.cpp)
blockrand_compile_together(elements  # styles/elements
  add_piece.cpp placed_model.cpp)
blockrand_compile_together(classify  # styles/classify
  catalogue.cpp classify.cpp evidence_model.cpp ground_floor.cpp votes.cpp)
blockrand_compile_together(classify  # styles/classify
  non_houses.cpp tag_features.cpp)
blockrand_compile_together(districts  # styles/districts
  assign.cpp presets.cpp read_rule_set.cpp rule_checks.cpp rule_set.cpp)
blockrand_compile_together(grammar  # styles/grammar
  evaluation/evaluate.cpp evaluation/evaluate_shape_functions.cpp evaluation/functions_arrays.cpp
  evaluation/functions_maths.cpp evaluation/functions_text.cpp evaluation/rule_tests.cpp language/known_names.cpp
  language/parse_successors.cpp language/parser_state.cpp language/source.cpp shapes/mesh_triangles.cpp shapes/split.cpp
  shapes/split_sizes.cpp)
blockrand_compile_together(grammar  # styles/grammar
  evaluation/asset_files.cpp evaluation/derive_attributes.cpp evaluation/functions_lists.cpp evaluation/pattern.cpp
  language/check.cpp language/check_styles.cpp language/function_names.cpp language/program.cpp
  language/resolve_names.cpp language/types.cpp shapes/extrude.cpp shapes/flat_face.cpp shapes/mesh_tools.cpp
  shapes/scatter.cpp shapes/selectors.cpp shapes/split_uv.cpp)
blockrand_compile_together(grammar  # styles/grammar
  evaluation/derive.cpp evaluation/functions_colour.cpp evaluation/operators.cpp language/bilke_import.cpp
  language/lexer.cpp language/other_names.cpp language/value_text.cpp shapes/component_shapes.cpp shapes/mesh_cut.cpp
  shapes/scope.cpp shapes/setback.cpp)
blockrand_compile_together(grammar  # styles/grammar
  evaluation/arrays.cpp language/check_types.cpp language/operation_names.cpp language/parse_declarations.cpp
  shapes/components.cpp shapes/initial_shape.cpp shapes/loose_edges.cpp shapes/plan_skeleton.cpp)
blockrand_compile_together(grammar  # styles/grammar
  evaluation/derive_blocks.cpp evaluation/derive_steps.cpp evaluation/functions.cpp evaluation/functions_conversion.cpp
  evaluation/functions_files.cpp language/check_rules.cpp language/check_sizes.cpp)
blockrand_compile_together(grammar  # styles/grammar
  language/file_search.cpp language/parse_expressions.cpp shapes/inner_rectangle.cpp shapes/insert.cpp
  shapes/mesh_operations.cpp shapes/normals.cpp shapes/offset.cpp shapes/operations.cpp shapes/raise_operations.cpp
  shapes/roofs.cpp shapes/scope_operations.cpp shapes/shape_envelope.cpp shapes/shape_materials.cpp
  shapes/tag_operations.cpp shapes/uv_operations.cpp)
blockrand_compile_together(picture  # pipeline/picture
  building_plan.cpp camera.cpp depth_map.cpp lighting.cpp palette.cpp plan.cpp png.cpp render.cpp scene.cpp
  sky_field.cpp view.cpp)
blockrand_compile_together(footprints  # pipeline/footprints
  area.cpp footprint_store.cpp load.cpp repair_extract.cpp roof_lines.cpp terrace_rows.cpp)
blockrand_compile_together(repair  # pipeline/footprints/repair
  arcs.cpp contacts.cpp kept_nodes.cpp nested_outlines.cpp repair_terrace_row.cpp shared_walls.cpp square_system.cpp
  wall_lines.cpp)
blockrand_compile_together(repair  # pipeline/footprints/repair
  clean_ring.cpp directions.cpp options.cpp ring_frames.cpp square.cpp terrace_records.cpp terrace_vertices.cpp)
blockrand_compile_together(repair  # pipeline/footprints/repair
  ground_overlaps.cpp terrace_graph.cpp terrace_lines.cpp)
blockrand_compile_together(repair  # pipeline/footprints/repair
  parts.cpp terrace_noise.cpp)
blockrand_compile_together(repair  # pipeline/footprints/repair
  parts_follow.cpp parts_share.cpp)
blockrand_compile_together(context  # pipeline/context
  address_points.cpp block_figures.cpp cells.cpp context_extract.cpp ground.cpp height_reference.cpp point_owner.cpp
  street_front.cpp tagged_neighbours.cpp vicinity_finder.cpp vicinity_index.cpp wall_contacts.cpp wall_samples.cpp
  wall_segments.cpp)
blockrand_compile_together(context  # pipeline/context
  blocks.cpp street_network.cpp wall_view.cpp)
blockrand_compile_together(context  # pipeline/context
  situation.cpp wall_points.cpp)
blockrand_compile_together(evidence  # pipeline/evidence
  building_facts.cpp region_priors.cpp style_values.cpp)
blockrand_compile_together(attributes  # pipeline/attributes
  area_set.cpp defaults.cpp options.cpp resolve.cpp resolver_heights.cpp resolver_roof.cpp roof_edges.cpp rule_sets.cpp
  tag_conflicts.cpp tagged_buildings.cpp)
blockrand_compile_together(attributes  # pipeline/attributes
  overrides.cpp read_overrides.cpp)
blockrand_compile_together(masses  # pipeline/masses
  built_mass.cpp envelope.cpp mass.cpp part_overlaps.cpp roofscape.cpp)
blockrand_compile_together(facades  # pipeline/facades
  element_library.cpp facade_context.cpp facade_segments.cpp facades.cpp grammar_library.cpp opening_blocks.cpp
  opening_proof.cpp openings.cpp outlines.cpp passages.cpp roof_installations.cpp wall_corners.cpp wall_frame.cpp)
blockrand_compile_together(outputs  # pipeline/outputs
  citygml/citygml_writer.cpp citygml/codes.cpp explain/find_explanation.cpp geopackage/context_rows.cpp
  geopackage/geopackage_output.cpp geopackage/geopackage_writer.cpp gltf/element_geometry.cpp gltf/material.cpp
  gltf/stored_element.cpp gzip.cpp placed_element.cpp report/report_map.cpp statistics.cpp tileset/tileset.cpp
  wall_segment_ids.cpp)
blockrand_compile_together(outputs  # pipeline/outputs
  citygml/geometry_text.cpp cityjson/cityjson_output.cpp cityjson/object_text.cpp cityjson/vertex_table.cpp
  explain/explain_output.cpp explain/situation_text.cpp geopackage/context_columns.cpp geopackage/qgis_styles.cpp
  gltf/meshopt.cpp gltf/property_table.cpp gltf/triangle_glb.cpp output.cpp
  report/report_json_output.cpp report/report_output.cpp report/report_tile.cpp)
blockrand_compile_together(outputs  # pipeline/outputs
  all_outputs.cpp citygml/appearance_text.cpp citygml/citygml_output.cpp cityjson/cityjson_writer.cpp
  cityjson/template_table.cpp explain/detail_text.cpp geopackage/context_layers.cpp geopackage/geopackage_rows.cpp
  geopackage/wall_segment_rows.cpp gltf/glb_document.cpp gltf/glb_writer.cpp gltf/gltf_output.cpp gltf/mesh_buffers.cpp
  options.cpp plan/plan_picture.cpp)
blockrand_compile_together(outputs  # pipeline/outputs
  geopackage/columns.cpp gltf/building_table.cpp gltf/instance_writer.cpp material_classes.cpp number_text.cpp
  report/pictures.cpp report/report_issues.cpp report/report_page.cpp)
blockrand_compile_together(outputs  # pipeline/outputs
  cityjson/detail_text.cpp explain/explanation.cpp explain/style_text.cpp report/report_styles.cpp)
blockrand_compile_together(run  # pipeline/run
  account.cpp build.cpp build_inputs.cpp configuration.cpp district_survey.cpp options.cpp outcome.cpp
  prepare_extract.cpp region_facts.cpp tile_choice.cpp tile_stages.cpp whole_model.cpp)
blockrand_compile_together(validate  # pipeline/validate
  attribute_names.cpp build_record.cpp bytes_of_file.cpp citygml_join.cpp citygml_names.cpp citygml_reader.cpp
  citygml_schema.cpp cityjson_reader.cpp cityjson_templates.cpp detail_check.cpp explanations.cpp format_agreement.cpp
  formats.cpp geopackage.cpp geopackage_context.cpp meshopt_view.cpp)
blockrand_compile_together(validate  # pipeline/validate
  cityjson_object_reader.cpp findings_summary.cpp geopackage_blob.cpp geopackage_rules.cpp glb_container.cpp options.cpp
  placed_elements.cpp places.cpp positions.cpp sqlite_file.cpp tile_check.cpp validate_build.cpp)
blockrand_compile_together(validate  # pipeline/validate
  glb.cpp part_overlap_check.cpp)
blockrand_compile_together(validate  # pipeline/validate
  property_table_reader.cpp tile_contents.cpp)
blockrand_compile_together(compare  # pipeline/compare
  body.cpp facade_agreement.cpp face_triangles.cpp heat_mesh.cpp matching.cpp report_csv.cpp
  report_elevation.cpp report_html.cpp report_json.cpp report_numbers.cpp report_pictures.cpp report_places.cpp
  report_svg.cpp roofs_from_above.cpp summary.cpp)
blockrand_compile_together(compare  # pipeline/compare
  comparison_sections.cpp cover.cpp measure_names.cpp opening_grid.cpp options.cpp report_charts.cpp
  report_geopackage.cpp report_text.cpp surfaces.cpp union_area.cpp)
blockrand_compile_together(compare  # pipeline/compare
  baseline.cpp facade_measures.cpp facade_pairs.cpp read_city.cpp report_match.cpp report_plan.cpp report_words.cpp)
blockrand_compile_together(compare  # pipeline/compare
  compare.cpp facade_planes.cpp)
blockrand_compile_together(settings  # pipeline/settings
  command_line.cpp command_options.cpp command_text.cpp config_file.cpp manual.cpp options.cpp reference.cpp)
blockrand_compile_together(cli  # pipeline/cli
  build_command.cpp build_report.cpp command.cpp compare_command.cpp configs_folder.cpp districts_command.cpp errors.cpp
  explain_style.cpp grammar_run.cpp help.cpp info_command.cpp signals.cpp validate_command.cpp)
blockrand_compile_together(cli  # pipeline/cli
  explain_command.cpp grammar_command.cpp)
blockrand_compile_together(cli  # pipeline/cli
  extract_summary.cpp rule_files.cpp)
