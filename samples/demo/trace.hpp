// trace.hpp  What ran when, for Perfetto (ui.perfetto.dev) or chrome://tracing.
#pragma once
#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

#include "sinew/sinew.hpp"

namespace sinew::demo {

// Listens to the world's markers. Events go into memory that is taken at the start; of a run with more, the
// last are kept, frame by frame.
class Trace {
 public:
  explicit Trace(bool listens);
  ProfilerHook hook();  // none where it does not listen
  void begin_frame();
  // Throws baker::BadInput when the path cannot be written.
  void write(const std::string& path) const;

 private:
  struct Event {
    const char* name;
    uint64_t at_ns;
    uint32_t instance, thread;
    bool begins;
  };
  static void add(Trace& trace, const char* name, uint32_t instance, bool begins);
  static constexpr uint32_t kFrames = 300;
  static constexpr uint64_t kEvents = uint64_t{1} << 20;

  std::unique_ptr<Event[]> events_;
  std::atomic<uint64_t> count_{0};
  uint64_t frame_begins_[kFrames] = {};
  uint64_t frames_ = 0;
};

}  // namespace sinew::demo
