#include "support/allocation_counter.h"

#include <cstdio>
#include <cstdlib>

namespace {

thread_local std::size_t count = 0;
thread_local bool forbidden = false;

void allocate() noexcept {
  ++count;
  if (!forbidden) return;
  forbidden = false;
  (void)std::fputs("memory was allocated where nothing may be\n", stderr);
  std::abort();
}

}  // namespace

std::size_t kerf::test::allocations() noexcept { return count; }
kerf::test::NoAllocation::NoAllocation() noexcept { forbidden = true; }
kerf::test::NoAllocation::~NoAllocation() { forbidden = false; }

// GCC says by macros what Clang says by features.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define KERF_SANITIZER_MALLOC 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define KERF_SANITIZER_MALLOC 1
#endif
#endif

#ifdef KERF_SANITIZER_MALLOC
// The sanitizers have a malloc of their own, and tell of each call.
extern "C" int __sanitizer_install_malloc_and_free_hooks(void (*on_malloc)(const volatile void*, std::size_t),
                                                         void (*on_free)(const volatile void*));
namespace {
[[maybe_unused]] const int installed = __sanitizer_install_malloc_and_free_hooks(
    [](const volatile void*, std::size_t) { allocate(); }, [](const volatile void*) {});
}
#else
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);

void* malloc(std::size_t size) {
  allocate();
  return __libc_malloc(size);
}
void* calloc(std::size_t number, std::size_t size) {
  allocate();
  return __libc_calloc(number, size);
}
void* realloc(void* memory, std::size_t size) {
  allocate();
  return __libc_realloc(memory, size);
}
}
#endif
