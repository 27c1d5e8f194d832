#include "trial/allocations.h"

#include <cstdlib>

// GCC says by macros what Clang says by features.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define KERF_SANITIZER_MALLOC 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define KERF_SANITIZER_MALLOC 1
#endif
#endif

#ifdef KERF_SANITIZER_MALLOC
std::optional<std::size_t> kerf::law_trial::allocations() noexcept { return std::nullopt; }
#else
namespace {
thread_local std::size_t count = 0;
}
std::optional<std::size_t> kerf::law_trial::allocations() noexcept { return count; }

// A program's own come before those of the C library, for what it loads too.
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* malloc(std::size_t size) noexcept {
  ++count;
  return __libc_malloc(size);
}
void* calloc(std::size_t number, std::size_t size) noexcept {
  ++count;
  return __libc_calloc(number, size);
}
void* realloc(void* memory, std::size_t size) noexcept {
  ++count;
  return __libc_realloc(memory, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  ++count;
  return __libc_memalign(alignment, size);
}
}
#endif
