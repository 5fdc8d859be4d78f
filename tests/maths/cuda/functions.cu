// CUDA C++'s functions, precise and fast, to measure beside ours: a kernel each, named as the test's table wants.
#include <cuda_runtime.h>

#define KERNEL(name, value)                                                                                  \
    extern "C" __global__ void name(const float2 *arguments, float *values, unsigned count) {                \
        for (unsigned i = blockIdx.x * blockDim.x + threadIdx.x; i < count; i += blockDim.x * gridDim.x) {    \
            const float x = arguments[i].x, y = arguments[i].y;                                              \
            (void)y;                                                                                         \
            values[i] = value;                                                                               \
        }                                                                                                    \
    }

KERNEL(cuda_sin, sinf(x))
KERNEL(cuda_cos, cosf(x))
KERNEL(cuda_tan, tanf(x))
KERNEL(cuda_asin, asinf(x))
KERNEL(cuda_acos, acosf(x))
KERNEL(cuda_atan, atanf(x))
KERNEL(cuda_sinh, sinhf(x))
KERNEL(cuda_cosh, coshf(x))
KERNEL(cuda_tanh, tanhf(x))
KERNEL(cuda_asinh, asinhf(x))
KERNEL(cuda_acosh, acoshf(x))
KERNEL(cuda_atanh, atanhf(x))
KERNEL(cuda_exp, expf(x))
KERNEL(cuda_exp2, exp2f(x))
KERNEL(cuda_exp10, exp10f(x))
KERNEL(cuda_expm1, expm1f(x))
KERNEL(cuda_log, logf(x))
KERNEL(cuda_log2, log2f(x))
KERNEL(cuda_log10, log10f(x))
KERNEL(cuda_log1p, log1pf(x))
KERNEL(cuda_cbrt, cbrtf(x))
KERNEL(cuda_pow, powf(x, y))
KERNEL(cuda_atan2, atan2f(x, y))
KERNEL(cuda_hypot, hypotf(x, y))
KERNEL(cuda_fmod, fmodf(x, y))
KERNEL(cuda_fast_sin, __sinf(x))
KERNEL(cuda_fast_cos, __cosf(x))
KERNEL(cuda_fast_tan, __tanf(x))
KERNEL(cuda_fast_tanh, __tanhf(x))
KERNEL(cuda_fast_exp, __expf(x))
KERNEL(cuda_fast_log, __logf(x))
KERNEL(cuda_fast_log2, __log2f(x))
KERNEL(cuda_fast_log10, __log10f(x))
KERNEL(cuda_fast_recip, __fdividef(1.0f, x))
KERNEL(cuda_fast_rsqrt, rsqrtf(x))
KERNEL(cuda_fast_pow_2_4, __powf(x, 2.4f))
