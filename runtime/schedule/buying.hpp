// buying.hpp  The levels that a budget buys, most weight x error saved a microsecond first.
//
// From one step to the next the budget ends at nearly the same key. So each candidate is asked first whether
// it stays what it is wherever near the last step's key the budget ends: two comparisons, and it is done
// with. Of the others, levels near that key are sorted into fine drawers, whose sums tell where the budget
// ends, and what is left over is spent key by key. Where it ends elsewhere it is looked for in a wider place,
// and then in coarse drawers of all levels of all.
// Costs count in whole 2^-20 us, so that sums do not depend on what was added first: what is bought depends
// on the candidates alone, not on where the search began.
#pragma once
#include "schedule/candidate.hpp"

namespace sinew::frame {

// It is asked at all: has a tick, and a level to choose.
inline bool chooses(const Candidate& c) noexcept { return !c.keeps_level && c.top > 0; }

struct Asked {
  double base_us = 0;    // what all take that are not simulated
  uint32_t overdue = 0;  // of scratch.overdue, in no order
};

class Buying {
 public:
  Buying(std::span<Candidate> candidates, ScheduleScratch& scratch) noexcept;
  // First of all. Works out rates.
  Asked ask_all() noexcept;
  // Level 1 is its own already.
  void give_turn(uint32_t candidate) noexcept;
  // One of them last: fills in level and planned_us.
  void buy(double left) noexcept;
  void buy_nothing() noexcept;
  void buy_all() noexcept;

 private:
  // Of keys, in fine drawers.
  struct Window {
    uint32_t first, end;
    float least, beyond;  // the smallest key in it, and above it
    bool moves(const Standing& s) const noexcept { return s.has_key < beyond || s.next_key >= least; }
  };
  static Window window_about(uint32_t drawer, uint32_t width) noexcept;

  void place(uint32_t candidate, double most) noexcept;
  void open(uint32_t candidate) noexcept;
  void search_about(uint32_t drawer, uint32_t width, double left) noexcept;
  bool find_lowest(double left) noexcept;
  uint32_t coarse_lowest(double left) noexcept;
  uint32_t take_open(double left) noexcept;
  uint32_t gather_next(uint32_t count) noexcept;
  uint32_t spend_rest(uint32_t count, float least_key) noexcept;

  std::span<Candidate> candidates_;
  ScheduleScratch& scratch_;
  Window window_;
  double closed_us_ = 0;  // what those take that stay
  uint32_t open_ = 0;     // of scratch.open
  bool wants_more_ = false;
  uint32_t lowest_ = 0;  // fine drawer: all above and in it is bought
  double rest_us_ = 0;   // of the budget then
};

}  // namespace sinew::frame
