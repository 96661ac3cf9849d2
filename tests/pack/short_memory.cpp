// short_memory.cpp  Replaces malloc, where no sanitizer has, and operator new.
#include "tests/pack/short_memory.hpp"

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <new>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define SINEW_OWN_MALLOC 0
#else
#define SINEW_OWN_MALLOC 1
#endif

namespace {

std::atomic<size_t> live{0};
thread_local size_t asked = 0, refused_nth = 0;
thread_local bool all_after = false;

bool is_refused() {
  ++asked;
  return refused_nth != 0 && (asked == refused_nth || (all_after && asked > refused_nth));
}

void* taken(void* memory) {
  if (memory) ++live;
  return memory;
}

}  // namespace

#if SINEW_OWN_MALLOC
extern "C" {
void* __libc_malloc(size_t);
void* __libc_calloc(size_t, size_t);
void* __libc_realloc(void*, size_t);
void* __libc_memalign(size_t, size_t);
void __libc_free(void*);
void* malloc(size_t bytes) {
  if (is_refused()) return errno = ENOMEM, nullptr;
  return taken(__libc_malloc(bytes));
}
void* calloc(size_t count, size_t bytes) {
  if (is_refused()) return errno = ENOMEM, nullptr;
  return taken(__libc_calloc(count, bytes));
}
void* realloc(void* old, size_t bytes) {
  if (is_refused()) return errno = ENOMEM, nullptr;
  void* made = __libc_realloc(old, bytes);
  if (!old) return taken(made);
  if (bytes == 0) --live;
  return made;
}
void* aligned_alloc(size_t alignment, size_t bytes) {
  if (is_refused()) return errno = ENOMEM, nullptr;
  return taken(__libc_memalign(alignment, bytes));
}
void* memalign(size_t alignment, size_t bytes) { return aligned_alloc(alignment, bytes); }
int posix_memalign(void** out, size_t alignment, size_t bytes) {
  void* made = aligned_alloc(alignment, bytes);
  if (made) *out = made;
  return made ? 0 : ENOMEM;
}
void free(void* old) {
  if (old) --live;
  __libc_free(old);
}
}
#endif

namespace {

// Not inlined: the compiler would see free() meet operator new and warn.
[[gnu::noinline]] void* take(size_t bytes, size_t alignment) {
#if !SINEW_OWN_MALLOC
  if (is_refused()) return nullptr;
  ++live;
#endif
  return std::aligned_alloc(alignment, (bytes + alignment) / alignment * alignment);
}

[[gnu::noinline]] void give_back(void* old) {
#if !SINEW_OWN_MALLOC
  if (old) --live;
#endif
  std::free(old);
}

void* take_or_throw(size_t bytes, size_t alignment) {
  if (void* made = take(bytes, alignment)) return made;
  throw std::bad_alloc();
}

constexpr size_t kUsual = alignof(std::max_align_t);

}  // namespace

void* operator new(size_t bytes) { return take_or_throw(bytes, kUsual); }
void* operator new(size_t bytes, const std::nothrow_t&) noexcept { return take(bytes, kUsual); }
void* operator new(size_t bytes, std::align_val_t alignment) {
  return take_or_throw(bytes, static_cast<size_t>(alignment));
}
void* operator new(size_t bytes, std::align_val_t alignment, const std::nothrow_t&) noexcept {
  return take(bytes, static_cast<size_t>(alignment));
}
void operator delete(void* old) noexcept { give_back(old); }
void operator delete(void* old, size_t) noexcept { give_back(old); }
void operator delete(void* old, std::align_val_t) noexcept { give_back(old); }
void operator delete(void* old, size_t, std::align_val_t) noexcept { give_back(old); }

namespace sinew::test {

void refuse_allocation(size_t nth, bool and_all_after) {
  asked = 0;
  refused_nth = nth;
  all_after = and_all_after;
}

size_t allocations_asked_for() {
  const size_t count = asked;
  refused_nth = 0;
  return count;
}

size_t live_blocks() { return live; }

}  // namespace sinew::test
