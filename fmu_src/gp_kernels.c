#include "gp_kernels.h"

/* Four doubles: left to itself, a compiler makes shuffles of a sum that has its order prescribed. */
#if defined(__GNUC__)
typedef double GpFour __attribute__((vector_size(32), aligned(8)));
#define GP_NO_FOUR {0, 0, 0, 0}
#define GP_ADD_PRODUCT(sum, a, b) ((sum) += *(const GpFour *)(a) * *(const GpFour *)(b))
#else
typedef double GpFour[4];
#define GP_NO_FOUR {0, 0, 0, 0}
#define GP_ADD_PRODUCT(sum, a, b) \
    do { for (int four = 0; four < 4; four++) (sum)[four] += (a)[four] * (b)[four]; } while (0)
#endif

#define GP_VARIANT _plain
#define GP_TARGET
#include "gp_kernels_body.h"

#if defined(__x86_64__) && defined(__GNUC__)
#include <cpuid.h>

#define GP_VARIANT _avx2
#define GP_TARGET __attribute__((target("avx2")))
#include "gp_kernels_body.h"

/* Whether processor and operating system have 256-bit vectors (Intel SDM, vol. 1, 14.3). */
static int has_avx2(void) {
    unsigned int a, b, c, d, low, high;
    if (!__get_cpuid(1, &a, &b, &c, &d) || !(c & (1u << 27)) || !(c & (1u << 28))) return 0; /* OSXSAVE, AVX */
    __asm__ volatile(".byte 0x0f, 0x01, 0xd0" : "=a"(low), "=d"(high) : "c"(0)); /* xgetbv */
    (void)high;
    if ((low & 6u) != 6u) return 0; /* the system saves both halves of the registers */
    return __get_cpuid_count(7, 0, &a, &b, &c, &d) && (b & (1u << 5));
}

const GpKernels *gp_kernels(void) { return has_avx2() ? &kernels_avx2 : &kernels_plain; }
#else
const GpKernels *gp_kernels(void) { return &kernels_plain; }
#endif
