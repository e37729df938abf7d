# Made by cmake/compiled_together.py, which says how and why: sources that are compiled as one, by target. A source that
# stands nowhere is compiled alone. Does a name of yours collide with one of another source? Take yours out.
blockrand_compile_together(base  # pipeline/base
  sha256.cpp portable_math.cpp parallel.cpp progress.cpp publish.cpp toml_file.cpp text.cpp markup.cpp option.cpp)
blockrand_compile_together(georef  # pipeline/georef
  crs.cpp crs_facts.cpp frames.cpp projection.cpp round_trip.cpp tile_frame.cpp tiles.cpp proj_transform.cpp)
blockrand_compile_together(geometry  # pipeline/geometry
  box_index.cpp polygon_measures.cpp weighted_skeleton.cpp weighted_sweep_events.cpp weighted_sweep_faces.cpp
  weighted_sweep_input.cpp roof_surfaces.cpp solid_builder.cpp plan_shape.cpp wall_segment.cpp even_odd.cpp slivers.cpp)
blockrand_compile_together(geometry  # pipeline/geometry
  check_solid.cpp ring_defects.cpp solid_overlap.cpp segment_grid.cpp)
blockrand_compile_together(geometry  # pipeline/geometry
  valid_polygon.cpp noded_lines.cpp triangle_conflicts.cpp)
blockrand_compile_together(importers_osm  # importers/osm
  accounts.cpp area_assembly.cpp bzip2_stream.cpp colour_names.cpp construction_date.cpp osm_features.cpp osm_file.cpp
  raw_data.cpp read_extract.cpp text_cleaner.cpp)
blockrand_compile_together(importers_osm  # importers/osm
  attributes.cpp equal_outlines.cpp interest.cpp pbf_blobs.cpp tag_values.cpp)
blockrand_compile_together(importers_elevation  # importers/elevation
  terrain.cpp bilinear.cpp)
blockrand_compile_together(importers_reference  # importers/reference
  axes.cpp citygml.cpp citygml_starts.cpp cityjson_geometry.cpp coordinate_text.cpp file_bytes.cpp footprints.cpp
  gltf.cpp gltf_scene.cpp gltf_table.cpp height_words.cpp links.cpp)
blockrand_compile_together(importers_reference  # importers/reference
  citygml_parser.cpp cityjson.cpp cityjson_objects.cpp polygons.cpp reference_crs.cpp reference_model.cpp
  tileset_tree.cpp affine_transform.cpp)
blockrand_compile_together(roofs  # styles/roofs
  build_roof.cpp roof_pitch.cpp lined_roofs.cpp simple_roofs.cpp apex_roofs.cpp profile_roofs.cpp wing_ends.cpp
  parapets.cpp cut_cells.cpp firewalls.cpp dormer_bodies.cpp dormers.cpp)
blockrand_compile_together(roofs  # styles/roofs
  skeleton_roofs.cpp roof_sides.cpp roof_outline.cpp overhangs.cpp roof_slopes.cpp element_layout.cpp cross_gables.cpp
  roof_windows.cpp chimney_places.cpp)
blockrand_compile_together(roofs  # styles/roofs
  eaves_lines.cpp plan_cells.cpp chimneys.cpp)
blockrand_compile_together(roofs  # styles/roofs
  gables.cpp gable_outline.cpp)
blockrand_compile_together(elements  # styles/elements
  flat_shapes.cpp mesh_builder.cpp profile.cpp profile_library.cpp sweep.cpp opening_shape.cpp opening_edges.cpp
  parameters.cpp trim.cpp joinery.cpp windows.cpp doors.cpp)
blockrand_compile_together(elements  # styles/elements
  kinds.cpp courses.cpp balconies.cpp corner_stones.cpp make_element.cpp)
blockrand_compile_together(classify  # styles/classify
  catalogue.cpp classify.cpp evidence_model.cpp ground_floor.cpp votes.cpp)
blockrand_compile_together(classify  # styles/classify
  non_houses.cpp tag_features.cpp)
blockrand_compile_together(districts  # styles/districts
  rule_set.cpp read_rule_set.cpp rule_checks.cpp assign.cpp presets.cpp)
blockrand_compile_together(grammar  # styles/grammar
  language/bilke_import.cpp language/check.cpp language/check_rules.cpp language/check_sizes.cpp
  language/check_styles.cpp language/check_types.cpp language/file_search.cpp language/function_names.cpp
  language/lexer.cpp language/parse_declarations.cpp language/source.cpp language/value_text.cpp)
blockrand_compile_together(grammar  # styles/grammar
  language/known_names.cpp language/operation_names.cpp language/parse_expressions.cpp language/parse_successors.cpp
  language/parser_state.cpp language/program.cpp language/resolve_names.cpp language/types.cpp shapes/mesh_triangles.cpp)
blockrand_compile_together(grammar  # styles/grammar
  shapes/component_shapes.cpp shapes/components.cpp shapes/shape_envelope.cpp
  shapes/extrude.cpp shapes/flat_face.cpp shapes/initial_shape.cpp shapes/inner_rectangle.cpp shapes/insert.cpp
  shapes/shape_materials.cpp shapes/normals.cpp)
blockrand_compile_together(grammar  # styles/grammar
  shapes/loose_edges.cpp shapes/mesh_cut.cpp shapes/mesh_operations.cpp shapes/mesh_tools.cpp shapes/offset.cpp
  shapes/operations.cpp shapes/plan_skeleton.cpp shapes/raise_operations.cpp shapes/scope.cpp shapes/setback.cpp
  shapes/split.cpp shapes/split_sizes.cpp)
blockrand_compile_together(grammar  # styles/grammar
  shapes/roofs.cpp shapes/scatter.cpp shapes/scope_operations.cpp shapes/selectors.cpp shapes/split_uv.cpp
  shapes/tag_operations.cpp shapes/uv_operations.cpp)
blockrand_compile_together(grammar  # styles/grammar
  evaluation/asset_files.cpp evaluation/derive_blocks.cpp evaluation/functions.cpp evaluation/functions_arrays.cpp
  evaluation/functions_colour.cpp evaluation/functions_conversion.cpp evaluation/functions_files.cpp
  evaluation/functions_maths.cpp evaluation/functions_text.cpp evaluation/pattern.cpp)
blockrand_compile_together(grammar  # styles/grammar
  evaluation/derive_steps.cpp evaluation/evaluate.cpp evaluation/evaluate_shape_functions.cpp
  evaluation/functions_lists.cpp)
blockrand_compile_together(picture  # pipeline/picture
  scene.cpp camera.cpp png.cpp palette.cpp view.cpp depth_map.cpp light.cpp render.cpp plan.cpp building_plan.cpp
  lettering.cpp)
blockrand_compile_together(footprints  # pipeline/footprints
  area.cpp footprint_store.cpp load.cpp repair_extract.cpp roof_lines.cpp terrace_rows.cpp)
blockrand_compile_together(repair  # pipeline/footprints/repair
  arcs.cpp contacts.cpp nested_outlines.cpp kept_nodes.cpp repair_terrace_row.cpp shared_walls.cpp square_system.cpp
  wall_lines.cpp)
blockrand_compile_together(repair  # pipeline/footprints/repair
  clean_ring.cpp directions.cpp ring_frames.cpp options.cpp terrace_records.cpp terrace_vertices.cpp square.cpp)
blockrand_compile_together(repair  # pipeline/footprints/repair
  ground_overlaps.cpp terrace_graph.cpp terrace_lines.cpp)
blockrand_compile_together(repair  # pipeline/footprints/repair
  parts.cpp terrace_noise.cpp)
blockrand_compile_together(context  # pipeline/context
  address_points.cpp block_figures.cpp cells.cpp context_extract.cpp wall_contacts.cpp wall_samples.cpp
  wall_segments.cpp ground.cpp height_reference.cpp point_owner.cpp street_front.cpp vicinity_finder.cpp)
blockrand_compile_together(context  # pipeline/context
  blocks.cpp wall_view.cpp street_network.cpp tagged_neighbours.cpp)
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
  opening_proof.cpp openings.cpp outlines.cpp passages.cpp roof_installations.cpp wall_corners.cpp)
blockrand_compile_together(outputs  # pipeline/outputs
  all_outputs.cpp citygml/citygml_output.cpp citygml/citygml_writer.cpp citygml/codes.cpp citygml/geometry_text.cpp
  cityjson/cityjson_output.cpp cityjson/detail_text.cpp cityjson/vertex_table.cpp explain/detail_text.cpp
  explain/explain_output.cpp explain/find_explanation.cpp explain/style_text.cpp)
blockrand_compile_together(outputs  # pipeline/outputs
  cityjson/cityjson_writer.cpp cityjson/object_text.cpp explain/explanation.cpp wall_segment_ids.cpp
  geopackage/context_columns.cpp geopackage/context_layers.cpp geopackage/context_rows.cpp
  geopackage/wall_segment_rows.cpp geopackage/geopackage_output.cpp gltf/building_table.cpp gltf/element_geometry.cpp
  gltf/glb_document.cpp)
blockrand_compile_together(outputs  # pipeline/outputs
  cityjson/template_table.cpp explain/situation_text.cpp geopackage/columns.cpp geopackage/qgis_styles.cpp
  gltf/gltf_output.cpp gltf/material.cpp gltf/meshopt.cpp gltf/property_table.cpp gzip.cpp placed_element.cpp
  options.cpp output.cpp)
blockrand_compile_together(outputs  # pipeline/outputs
  geopackage/geopackage_rows.cpp gltf/glb_writer.cpp gltf/instance_writer.cpp gltf/mesh_buffers.cpp
  gltf/stored_element.cpp plan/plan_picture.cpp report/page_assets.cpp report/pictures.cpp report/report_json_output.cpp
  report/report_page.cpp report/report_tile.cpp)
blockrand_compile_together(outputs  # pipeline/outputs
  geopackage/geopackage_writer.cpp gltf/triangle_glb.cpp report/report_issues.cpp statistics.cpp number_text.cpp
  tileset/tileset.cpp)
blockrand_compile_together(outputs  # pipeline/outputs
  report/report_map.cpp report/report_output.cpp)
blockrand_compile_together(run  # pipeline/run
  account.cpp build.cpp build_inputs.cpp configuration.cpp district_survey.cpp options.cpp outcome.cpp
  prepare_extract.cpp region_facts.cpp tile_choice.cpp tile_stages.cpp whole_model.cpp)
blockrand_compile_together(validate  # pipeline/validate
  attribute_names.cpp build_record.cpp citygml_reader.cpp citygml_join.cpp citygml_names.cpp citygml_schema.cpp
  cityjson_reader.cpp cityjson_templates.cpp format_agreement.cpp formats.cpp detail_check.cpp explanations.cpp)
blockrand_compile_together(validate  # pipeline/validate
  cityjson_object_reader.cpp bytes_of_file.cpp geopackage.cpp geopackage_blob.cpp geopackage_context.cpp
  geopackage_rules.cpp glb_container.cpp meshopt_view.cpp options.cpp placed_elements.cpp places.cpp)
blockrand_compile_together(validate  # pipeline/validate
  glb.cpp part_overlap_check.cpp positions.cpp sqlite_file.cpp findings_summary.cpp)
blockrand_compile_together(validate  # pipeline/validate
  property_table_reader.cpp tile_check.cpp tile_contents.cpp validate_build.cpp)
blockrand_compile_together(compare  # pipeline/compare
  baseline.cpp body.cpp compare.cpp cover.cpp face_triangles.cpp facade_pairs.cpp heat_mesh.cpp matching.cpp
  measure_names.cpp report_assets.cpp report_charts.cpp report_geopackage.cpp)
blockrand_compile_together(compare  # pipeline/compare
  facade_measures.cpp facade_planes.cpp opening_grid.cpp options.cpp report_pictures.cpp report_places.cpp
  report_text.cpp report_words.cpp surfaces.cpp)
blockrand_compile_together(compare  # pipeline/compare
  facade_agreement.cpp read_city.cpp report_csv.cpp report_html.cpp report_match.cpp report_numbers.cpp report_plan.cpp
  roofs_from_above.cpp summary.cpp)
blockrand_compile_together(compare  # pipeline/compare
  report_json.cpp union_area.cpp)
blockrand_compile_together(settings  # pipeline/settings
  options.cpp command_options.cpp config_file.cpp command_line.cpp command_text.cpp reference.cpp manual.cpp)
blockrand_compile_together(cli  # pipeline/cli
  build_command.cpp build_report.cpp command.cpp compare_command.cpp configs_folder.cpp districts_command.cpp errors.cpp
  explain_style.cpp grammar_run.cpp help.cpp info_command.cpp signals.cpp)
blockrand_compile_together(cli  # pipeline/cli
  explain_command.cpp grammar_command.cpp validate_command.cpp)
blockrand_compile_together(cli  # pipeline/cli
  extract_summary.cpp rule_files.cpp)
