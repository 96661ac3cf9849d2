// trace.cpp  see trace.hpp.
#include "samples/demo/trace.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <thread>

#include "baker/common/files/write_file.hpp"

namespace sinew::demo {
namespace {

uint64_t now_ns() {
  return static_cast<uint64_t>(std::chrono::steady_clock::now().time_since_epoch() /
                               std::chrono::nanoseconds(1));
}

uint32_t thread_number() {
  static std::atomic<uint32_t> next{0};
  thread_local const uint32_t number = next++;
  return number;
}

}  // namespace

Trace::Trace(bool listens) : events_(listens ? new Event[kEvents] : nullptr) {}

ProfilerHook Trace::hook() {
  if (!events_) return {};
  return {.begin = [](const char* name, uint32_t instance,
                      void* context) { add(*static_cast<Trace*>(context), name, instance, true); },
          .end = [](const char* name, uint32_t instance,
                    void* context) { add(*static_cast<Trace*>(context), name, instance, false); },
          .context = this};
}

void Trace::add(Trace& trace, const char* name, uint32_t instance, bool begins) {
  trace.events_[trace.count_.fetch_add(1, std::memory_order_relaxed) % kEvents] = {name, now_ns(), instance,
                                                                                   thread_number(), begins};
}

void Trace::begin_frame() { frame_begins_[frames_++ % kFrames] = count_; }

void Trace::write(const std::string& path) const {
  const uint64_t end = count_, oldest = end - std::min(end, kEvents);
  uint64_t first = end;
  for (uint64_t f = 0; f < std::min<uint64_t>(frames_, kFrames); ++f)
    if (frame_begins_[f] >= oldest) first = std::min(first, frame_begins_[f]);
  std::string out = "{\"displayTimeUnit\":\"ns\",\"traceEvents\":[";
  for (uint64_t e = first; e < end; ++e) {
    const Event& event = events_[e % kEvents];
    char line[160];
    const int32_t instance = event.instance == kNoInstance ? -1 : static_cast<int32_t>(event.instance);
    std::snprintf(
        line, sizeof line,
        "%s\n{\"name\":\"%s\",\"ph\":\"%c\",\"ts\":%.3f,\"pid\":1,\"tid\":%u,\"args\":{\"instance\":%d}}",
        e == first ? "" : ",", event.name, event.begins ? 'B' : 'E',
        1e-3 * static_cast<double>(event.at_ns - events_[first % kEvents].at_ns), event.thread, instance);
    out += line;
  }
  baker::write_file(path, std::string_view(out += "\n]}\n"));
}

}  // namespace sinew::demo
