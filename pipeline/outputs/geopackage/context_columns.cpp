// Columns of what repair, context and classification find.
#include "pipeline/outputs/geopackage/columns.h"

namespace blockrand::outputs {
namespace {

constexpr ColumnKind kInteger = ColumnKind::integer, kReal = ColumnKind::real, kText = ColumnKind::text;

}  // namespace

std::vector<Column> style_columns() {
  return {
      {"style_p", kReal, "", "Probability of the likeliest class of appearance; empty: was not classified"},
      {"p_gruenderzeit", kReal, "", "Probability: street-side house of 1840 to 1918 with a composed front"},
      {"p_tenement", kReal, "", "Probability: mass housing of that time without one, wings and rear buildings"},
      {"p_modern", kReal, "", "Probability: designed after 1918"},
      {"p_other", kReal, "", "Probability: church, shed, garage, house from before 1840"},
      {"morphology", kText, "",
       "How the houses of its quarter stand: perimeter_block, old_town, slab, detached, terrace; empty: was not "
       "classified"},
  };
}

std::vector<Column> situation_columns() {
  return {
      {"position", kText, "",
       "free_standing, end_of_row, mid_row, corner_house; rear_building: inside the block; side_wing: inside the "
       "block, "
       "along the border of its lot; unknown"},
      {"front_orientation", kReal, "degree", "Where the main front looks, clockwise from grid north"},
      {"depth", kReal, "m", "Extent across the main front; without a front the shorter side"},
      {"width", kReal, "m", "Extent along the main front; without a front the longer side"},
      {"setback", kReal, "m", "From the building line of the street back to the main front"},
      {"party_wall_length", kReal, "m", "Length of the walls that are shared with neighbours"},
      {"block", kText, "", "Id of its block in the layer blocks"},
      {"courtyards", kText, "",
       "Ids of the courtyards that it stands at, in the layer courtyards, separated by blanks"},
  };
}

std::vector<Column> repair_columns() {
  return {
      {"moved", kInteger, "", "Corners of the outline that repair moved by more than 1 mm"},
      {"mean_shift", kReal, "m", "How far the moved corners of the outline were moved, on average"},
      {"max_shift", kReal, "m", "How far a corner of the outline was moved at most"},
      {"mapped_area", kReal, "m²", "Area of the outline as mapped, before repair"},
      {"shared_walls", kInteger, "", "Stretches of the outline whose points a neighbour has as well"},
      {"gaps_closed", kInteger, "", "Of the shared walls: those that did not touch as mapped"},
      {"overlaps_resolved", kInteger, "", "Neighbours that it overlapped as mapped and does no longer"},
      {"overlap_left", kReal, "m²", "Area that it still has in common with others at the same level"},
      {"squared_direction", kReal, "degree",
       "Direction of the main walls that others were made parallel or square to, clockwise from grid north"},
  };
}

std::vector<Column> wall_segment_columns() {
  return {
      {"id", kText, "",
       "Building and the OpenStreetMap nodes at both ends of the edge; .1, .2 for its further stretches"},
      {"building", kText, "", "Id of the building it belongs to"},
      {"kind", kText, "",
       "What it faces: street, courtyard, side (a gap to a neighbour), party_wall, passage; unknown"},
      {"confidence", kReal, "", "How sure the kind is, from 0 to 1"},
      {"length", kReal, "m", "Length of the stretch"},
      {"orientation", kReal, "degree", "Where it looks, clockwise from grid north"},
      {"front", kInteger, "", "1: part of the building's main fronts"},
      {"neighbour", kText, "", "Party wall: the building on the other side"},
      {"covered_height", kReal, "m", "Party wall: how high the neighbour covers it"},
      {"street", kText, "", "Id of the street that it faces"},
      {"street_name", kText, "", "Name of that street"},
      {"street_class", kText, "", "Class of that street"},
      {"street_distance", kReal, "m", "From the middle of the stretch to the middle of the street"},
      {"street_angle", kReal, "degree", "Between the stretch and the street, from 0 to 90"},
      {"visibility", kReal, "", "How much of it is seen from the street, from 0 to 1"},
      {"corner_start", kInteger, "", "1: a street corner lies where it begins"},
      {"corner_end", kInteger, "", "1: a street corner lies where it ends"},
      {"chamfer", kInteger, "", "1: it cuts off a street corner"},
      {"entrances", kInteger, "", "Number of mapped entrances on it"},
      {"house_numbers", kText, "", "House numbers of the entrances and address nodes at it, separated by semicolons"},
      {"points", kText, "", "Ids of the mapped entrances and address nodes at it, separated by blanks"},
      {"trees", kInteger, "", "Number of mapped trees before it, nearer to it than to the building's other stretches"},
      {"arc_radius", kReal, "m", "Radius of the curve that it is a piece of"},
      {"arc_bulge", kText, "", "outward or inward, where it is a piece of a curve"},
      {"from_node", kInteger, "", "OpenStreetMap node where its edge begins; empty where repair made the point"},
      {"to_node", kInteger, "", "OpenStreetMap node where its edge ends; empty where repair made the point"},
  };
}

std::vector<Column> block_columns() {
  return {
      {"id", kText, "", "A way, a node on it and the side that the block lies on"},
      {"kind", kText, "",
       "ordinary; between_carriageways, between_tracks, street_space (an island or square), water: give no ratios"},
      {"area", kReal, "m²", "Area up to the middle of the streets around it"},
      {"cut_by_extract_edge", kInteger, "", "1: reaches beyond the data, so that it gives no ratios"},
      {"too_large", kInteger, "", "1: larger than a block of houses, so that it gives no ratios"},
      {"buildings", kInteger, "", "Number of buildings that belong to it"},
      {"built_share", kReal, "", "Area of footprints by area of the block (GRZ up to the middle of the streets)"},
      {"tagged_share", kReal, "", "Of the area of footprints: the share under buildings with mapped storeys"},
      {"floor_area_ratio", kReal, "", "Floor area by area of the block (GFZ), from mapped storeys"},
      {"closure", kReal, "", "Share of the street front that is built"},
      {"front_length", kReal, "m", "Street front that closure was measured on"},
      {"courtyard_area", kReal, "m²", "Area of its courtyards"},
      {"courtyards", kInteger, "", "Number of its courtyards"},
      {"streets", kText, "", "Streets around it, separated by semicolons"},
  };
}

std::vector<Column> footprint_before_columns() {
  return {
      {"id", kText, "", "Id of the building, in the layer buildings"},
      {"state", kText, "",
       "moved: it stands where the image shows it; seen_elsewhere: it was not to be moved; reshaped: single walls "
       "stand where "
       "the image shows them; seen_reshaped: they were not to be shifted; as_mapped; undecided; refused"},
      {"reason", kText, "", "Why it was not moved"},
      {"shift", kReal, "m", "From where it is mapped to where the image shows it"},
      {"shift_east", kReal, "m", "Of that: to the east"},
      {"shift_north", kReal, "m", "Of that: to the north"},
      {"rotation", kReal, "degree", "Counter-clockwise, about the middle of its row, before the shift"},
      {"evidence_before", kReal, "",
       "How much of its walls lies on edges of the image where it is mapped, from 0 to 1"},
      {"evidence_after", kReal, "", "The same where the image shows it"},
      {"gain", kReal, "", "The difference of the two"},
      {"confidence", kReal, "", "How sure it is that it stands there, from 0 to 1"},
      {"walls_shifted", kInteger, "", "How many of its walls the image shows beside the others"},
      {"largest_wall_shift", kReal, "m", "How far, the farthest of them"},
      {"walls_reason", kText, "", "Why they stay where they are, where they do"},
      {"walls_evidence_before", kReal, "", "How clear the edges of all its walls are without that, from 0 to 1"},
      {"walls_evidence_after", kReal, "", "The same with it"},
      {"walls_confidence", kReal, "", "How sure it is that they stand nearer to the truth then, from 0 to 1"},
      {"perhaps_gone", kReal, "", "How likely it is that nothing stands there any more, from 0.85 on; else 0"},
      {"lean", kReal, "m", "How far the image shows its roof from its ground"},
      {"image", kText, "", "The image"},
      {"image_date", kText, "", "When it was taken"},
      {"licence", kText, "", "Licence of the image"},
  };
}

std::vector<Column> unmapped_columns() {
  return {
      {"id", kText, "", "By its place: u and the square of 2 m of the reference system in which its middle lies"},
      {"probability", kReal, "", "How likely it is that a building stands there, from 0.85 on"},
      {"area", kReal, "m²", "Area of the outline"},
      {"outline_of", kText, "",
       "ground: where it stands, by the lean of roofs in the image and its size; roof: where the image shows it, the "
       "lean "
       "being unknown"},
      {"lean", kReal, "m", "How far the image shows its roof from the outline"},
      {"image", kText, "", "The image"},
      {"image_date", kText, "", "When it was taken"},
      {"licence", kText, "", "Licence of the image"},
  };
}

std::vector<Column> courtyard_columns() {
  return {
      {"id", kText, "", "A building at it and a place of that building's outline"},
      {"block", kText, "", "Id of its block in the layer blocks"},
      {"area", kReal, "m²", "Area of the open space"},
      {"closed", kInteger, "", "1: no open way leads to the street; 0: one does"},
      {"opening", kReal, "m", "Width of the gaps that lead out, together"},
      {"buildings", kInteger, "", "Number of buildings around it"},
      {"building_ids", kText, "", "Their ids, separated by blanks"},
  };
}

std::vector<Column> cell_columns() {
  return {
      {"id", kText, "", "Column and row of the square, counted from the origin of the reference system"},
      {"size", kReal, "m", "Side of the square"},
      {"buildings", kInteger, "",
       "Number of buildings whose middle lies in it; canopies and what floats are not counted"},
      {"covered_share", kReal, "", "Share of its area within the data; below 0.95 it gives no ratios by its area"},
      {"density", kReal, "1/ha", "Buildings per hectare; empty where the data does not cover it"},
      {"built_share", kReal, "", "Area of footprints by area of the square; empty where the data does not cover it"},
      {"tagged_share", kReal, "", "Share of the buildings with mapped storeys"},
      {"storeys_mean", kReal, "", "Mean of the mapped storeys"},
      {"storeys_spread", kReal, "", "Standard deviation of the mapped storeys"},
      {"floor_area_ratio", kReal, "",
       "Floor area by area of the square, from mapped storeys; empty where the data does not cover it"},
      {"party_wall_share", kReal, "", "Share of the outlines' length that is shared with neighbours"},
      {"dated_share", kReal, "", "Share of the buildings with a mapped year"},
      {"year_mean", kReal, "", "Mean of the mapped years"},
      {"year_spread", kReal, "", "Standard deviation of the mapped years; in years"},
      {"footprint_quartile", kReal, "m²", "A quarter of the footprints are smaller"},
      {"footprint_median", kReal, "m²", "Half of the footprints are smaller"},
      {"footprint_upper_quartile", kReal, "m²", "Three quarters of the footprints are smaller"},
  };
}

}  // namespace blockrand::outputs
