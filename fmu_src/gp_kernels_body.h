/* The kernels, compiled once for each GP_VARIANT (a suffix of their names) with GP_TARGET. No include guard: gp_kernels.c
   includes this several times. */
#define GP_JOIN(name, variant) name##variant
#define GP_NAME(name, variant) GP_JOIN(name, variant)

GP_TARGET static double GP_NAME(dot, GP_VARIANT)(const double *a, const double *b, size_t n) {
    GpFour s = GP_NO_FOUR, t = GP_NO_FOUR; /* two sums of four: hides the latency of an addition */
    size_t i = 0;
    for (; i + 8 <= n; i += 8) {
        GP_ADD_PRODUCT(s, a + i, b + i);
        GP_ADD_PRODUCT(t, a + i + 4, b + i + 4);
    }
    for (; i < n; i++) s[0] += a[i] * b[i];
    return ((s[0] + t[0]) + (s[1] + t[1])) + ((s[2] + t[2]) + (s[3] + t[3]));
}

/* The same order of additions as `dot`: a value does not depend on what else is asked for. */
GP_TARGET static void GP_NAME(dot4, GP_VARIANT)(const double *const a[4], const double *b, size_t n,
                                                double result[4]) {
    const double *a0 = a[0], *a1 = a[1], *a2 = a[2], *a3 = a[3];
    GpFour s0 = GP_NO_FOUR, s1 = GP_NO_FOUR, s2 = GP_NO_FOUR, s3 = GP_NO_FOUR;
    GpFour t0 = GP_NO_FOUR, t1 = GP_NO_FOUR, t2 = GP_NO_FOUR, t3 = GP_NO_FOUR;
    size_t i = 0;
    for (; i + 8 <= n; i += 8) {
        GP_ADD_PRODUCT(s0, a0 + i, b + i);
        GP_ADD_PRODUCT(s1, a1 + i, b + i);
        GP_ADD_PRODUCT(s2, a2 + i, b + i);
        GP_ADD_PRODUCT(s3, a3 + i, b + i);
        GP_ADD_PRODUCT(t0, a0 + i + 4, b + i + 4);
        GP_ADD_PRODUCT(t1, a1 + i + 4, b + i + 4);
        GP_ADD_PRODUCT(t2, a2 + i + 4, b + i + 4);
        GP_ADD_PRODUCT(t3, a3 + i + 4, b + i + 4);
    }
    for (; i < n; i++) {
        s0[0] += a0[i] * b[i];
        s1[0] += a1[i] * b[i];
        s2[0] += a2[i] * b[i];
        s3[0] += a3[i] * b[i];
    }
    result[0] = ((s0[0] + t0[0]) + (s0[1] + t0[1])) + ((s0[2] + t0[2]) + (s0[3] + t0[3]));
    result[1] = ((s1[0] + t1[0]) + (s1[1] + t1[1])) + ((s1[2] + t1[2]) + (s1[3] + t1[3]));
    result[2] = ((s2[0] + t2[0]) + (s2[1] + t2[1])) + ((s2[2] + t2[2]) + (s2[3] + t2[3]));
    result[3] = ((s3[0] + t3[0]) + (s3[1] + t3[1])) + ((s3[2] + t3[2]) + (s3[3] + t3[3]));
}

GP_TARGET static void GP_NAME(axpy, GP_VARIANT)(double *restrict y, double alpha, const double *restrict x, size_t n) {
    for (size_t i = 0; i < n; i++) y[i] += alpha * x[i];
}

GP_TARGET static void GP_NAME(add_columns, GP_VARIANT)(double *restrict y, const double *restrict A,
                                                       const double *restrict x, size_t n, size_t columns) {
    size_t j = 0;
    for (; j + 4 <= columns; j += 4, A += 4 * n) { /* four at a time: a quarter of the traffic on y */
        const double x0 = x[j], x1 = x[j + 1], x2 = x[j + 2], x3 = x[j + 3];
        const double *a0 = A, *a1 = a0 + n, *a2 = a1 + n, *a3 = a2 + n;
        for (size_t i = 0; i < n; i++) y[i] += (a0[i] * x0 + a1[i] * x1) + (a2[i] * x2 + a3[i] * x3);
    }
    for (; j + 2 <= columns; j += 2, A += 2 * n) {
        const double x0 = x[j], x1 = x[j + 1], *a0 = A, *a1 = a0 + n;
        for (size_t i = 0; i < n; i++) y[i] += a0[i] * x0 + a1[i] * x1;
    }
    for (; j < columns; j++, A += n)
        for (size_t i = 0; i < n; i++) y[i] += A[i] * x[j];
}

GP_TARGET static void GP_NAME(pairs, GP_VARIANT)(const double *restrict c, const double *restrict now,
                                                 double *restrict next, size_t N) {
    const double *a = now, *b = now + N;
    for (size_t k = 0; k < N; k++) next[k] = a[k] + (c[k] * a[k] + c[N + k] * b[k]);
    for (size_t k = 0; k < N; k++) next[N + k] = b[k] + (c[2 * N + k] * a[k] + c[3 * N + k] * b[k]);
}

GP_TARGET static void GP_NAME(multiply, GP_VARIANT)(double *restrict C, const double *restrict A,
                                                    const double *restrict B, size_t n) {
    for (size_t i = 0; i < n; i++) {
        double *c = C + i * n;
        const double *a = A + i * n;
        size_t k = 0;
        for (size_t j = 0; j < n; j++) c[j] = 0;
        for (; k + 4 <= n; k += 4) {
            const double a0 = a[k], a1 = a[k + 1], a2 = a[k + 2], a3 = a[k + 3];
            const double *b0 = B + k * n, *b1 = b0 + n, *b2 = b1 + n, *b3 = b2 + n;
            if (a0 == 0 && a1 == 0 && a2 == 0 && a3 == 0) continue; /* block matrices have many zeros */
            for (size_t j = 0; j < n; j++) c[j] += (a0 * b0[j] + a1 * b1[j]) + (a2 * b2[j] + a3 * b3[j]);
        }
        for (; k < n; k++)
            for (size_t j = 0; j < n; j++) c[j] += a[k] * B[k * n + j];
    }
}

static const GpKernels GP_NAME(kernels, GP_VARIANT) = {GP_NAME(dot, GP_VARIANT), GP_NAME(dot4, GP_VARIANT), GP_NAME(axpy, GP_VARIANT),
                                                       GP_NAME(add_columns, GP_VARIANT), GP_NAME(pairs, GP_VARIANT),
                                                       GP_NAME(multiply, GP_VARIANT)};

#undef GP_NAME
#undef GP_JOIN
#undef GP_VARIANT
#undef GP_TARGET
