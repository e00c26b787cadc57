#include "gp_complex.h"

#include "gp_linalg.h"

GpComplex gp_cmul(GpComplex a, GpComplex b) {
    GpComplex c;
    c.re = a.re * b.re - a.im * b.im;
    c.im = a.re * b.im + a.im * b.re;
    return c;
}

GpComplex gp_cdiv(GpComplex a, GpComplex b) {
    GpComplex c;
    if (gp_magnitude(b.re) >= gp_magnitude(b.im)) {
        const double r = b.im / b.re, d = b.re + b.im * r;
        c.re = (a.re + a.im * r) / d;
        c.im = (a.im - a.re * r) / d;
    } else {
        const double r = b.re / b.im, d = b.re * r + b.im;
        c.re = (a.re * r + a.im) / d;
        c.im = (a.im * r - a.re) / d;
    }
    return c;
}

GpComplex gp_complex(double re, double im) {
    GpComplex z;
    z.re = re;
    z.im = im;
    return z;
}

GpComplex gp_cadd(GpComplex a, GpComplex b) { return gp_complex(a.re + b.re, a.im + b.im); }
GpComplex gp_csub(GpComplex a, GpComplex b) { return gp_complex(a.re - b.re, a.im - b.im); }
GpComplex gp_cscale(double a, GpComplex z) { return gp_complex(a * z.re, a * z.im); }
double gp_csize(GpComplex z) { return gp_magnitude(z.re) + gp_magnitude(z.im); }

GpComplex gp_cdot(const double *a, const GpComplex *z, size_t n) {
    GpComplex sum = {0, 0};
    for (size_t i = 0; i < n; i++) {
        sum.re += a[i] * z[i].re;
        sum.im += a[i] * z[i].im;
    }
    return sum;
}

static void subtract_multiple(GpComplex *y, GpComplex factor, const GpComplex *x, size_t n) {
    for (size_t i = 0; i < n; i++) {
        const GpComplex p = gp_cmul(factor, x[i]);
        y[i].re -= p.re;
        y[i].im -= p.im;
    }
}

int gp_csolve(GpComplex *A, GpComplex *b, size_t n) {
    for (size_t k = 0; k < n; k++) {
        size_t p = k;
        double best = -1;
        for (size_t i = k; i < n; i++) {
            const double size = gp_csize(A[i * n + k]);
            if (size > best) { best = size; p = i; }
        }
        if (!(best > 0)) return -1;
        if (p != k) {
            GpComplex t = b[k];
            b[k] = b[p];
            b[p] = t;
            for (size_t j = 0; j < n; j++) {
                t = A[k * n + j];
                A[k * n + j] = A[p * n + j];
                A[p * n + j] = t;
            }
        }
        for (size_t i = k + 1; i < n; i++) {
            const GpComplex factor = gp_cdiv(A[i * n + k], A[k * n + k]);
            subtract_multiple(A + i * n + k + 1, factor, A + k * n + k + 1, n - k - 1);
            subtract_multiple(b + i, factor, b + k, 1);
        }
    }
    for (size_t k = n; k-- > 0;) {
        for (size_t i = k + 1; i < n; i++) subtract_multiple(b + k, A[k * n + i], b + i, 1);
        b[k] = gp_cdiv(b[k], A[k * n + k]);
    }
    return 0;
}
