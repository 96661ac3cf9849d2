// cage_fields.hpp  What the surface knows, spread over a cage's nodes: skin influences, stiffness, distance
// to the surface.
#pragma once
#include "baker/truth/cage/cage_topology.hpp"

namespace sinew::baker {

struct PlacedSample {
  SurfaceSample at;
  Cage::Place place;
};

// Least squares: the cage's interpolation meets the surface's values at the samples, and is smooth (graph
// Laplacian) where they are silent.
struct CageFields {
  std::vector<Influences> skin;
  std::vector<double> stiffness;
};
CageFields fit_fields(const Character& character, const std::vector<double>& vertex_stiffness,
                      const CageTopology& topology, const std::vector<PlacedSample>& samples);

// Metres from every node to the surface, found along the cage: the other side of a gap does not count.
std::vector<double> surface_distance(const CageTopology& topology, const std::vector<PlacedSample>& samples);

}  // namespace sinew::baker
