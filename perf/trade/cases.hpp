// cases.hpp  What perf_trade_rods compares: a row for each scene, solver and start. A new one is a new row.
#pragma once
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "baker/research/rods/compared_solver.hpp"

namespace sinew::perf {

using Segments = std::vector<rods::SegmentDef>;

struct TradeScene {
  const char* name;
  bool tree, contacts;
  float dt_s;
  Segments (*rod)(uint32_t segments, double young_pa);
  // What a new collider of a scene with contacts is to know.
  Status (*furnish)(rods::RodCollider& collider);
  // Before a step: what is held goes where it should be at the step's end.
  void (*drive)(rods::RodBatch& batch, int step);
};

struct TradeSolver {
  const char* name;
  baker::SolverKind kind;
  bool contacts;             // knows them
  uint32_t most_iterations;  // given up beyond
  bool inner;                // iterates inside an iteration: slow on long rods, so measured at fewer states
};

struct TradeStart {
  const char* name;
  rods::RodStart start;
  const rods::CopingNet* network = nullptr;  // of kLearned
  rods::RodCorrection correction = {};       // of kContinued
};

std::span<const TradeScene> trade_scenes();
std::span<const TradeSolver> trade_solvers();
// Those that need no file.
std::span<const TradeStart> trade_starts();

// One line of the table: a rod in a scene, with a solver and a start.
struct TradeCase {
  const TradeScene* scene;
  uint32_t strands, segments;
  double young_pa;
  const TradeSolver* solver;
  const TradeStart* start;
};

// "chain,1,30,1e+06,direct,previous": the first columns of its lines.
std::string key_of(const TradeCase& c);

// All of them, or a few of each kind. They point to the starts.
std::vector<TradeCase> trade_cases(std::span<const TradeStart> starts, bool quick);

}  // namespace sinew::perf
