#include "gp_waves.h"

#include "gp_linalg.h"

static const double TWO_PI = 6.283185307179586476925286766559;

const double gp_gauss_points[GP_LEGENDRE] = {
    0.009219682876640375, 0.04794137181476257, 0.11504866290284765, 0.2063410228566913,
    0.3160842505009099,   0.43738329574426554, 0.5626167042557345,  0.6839157494990901,
    0.7936589771433087,   0.8849513370971523,  0.9520586281852375,  0.9907803171233597};
static const double gauss_weights[GP_LEGENDRE] = {
    0.023587668193255914, 0.05346966299765921, 0.08003916427167311, 0.10158371336153296,
    0.1167462682691774,   0.12457352290670139, 0.12457352290670139, 0.1167462682691774,
    0.10158371336153296,  0.08003916427167311, 0.05346966299765921, 0.023587668193255914};

GpComplex gp_expm1(GpComplex z) {
    GpComplex sum = {0, 0}, term;
    int doublings = 0;
    while (gp_csize(z) > 0.25 && doublings < 1100) {
        z = gp_cscale(0.5, z);
        doublings++;
    }
    for (int k = 14; k > 0; k--) { /* z/1 (1 + z/2 (1 + z/3 (...))) */
        sum.re += 1;
        sum = gp_cscale(1.0 / k, gp_cmul(sum, z));
    }
    for (; doublings > 0; doublings--) { /* e^2z - 1 = F (2 + F) */
        term = sum;
        term.re += 2;
        sum = gp_cmul(sum, term);
    }
    return sum;
}

static double nearest_integer(double x) { /* of |x| < 2^52; larger doubles are whole anyway */
    const double shift = 6755399441055744.0; /* 1.5 * 2^52 */
    volatile double y = x + shift;           /* volatile: the sum must be rounded to a double */
    return gp_magnitude(x) < 4503599627370496.0 ? y - shift : x;
}

GpComplex gp_turn(double x) {
    const double r = x - nearest_integer(x), quarter = nearest_integer(4 * r);
    const double y = TWO_PI * (r - 0.25 * quarter), y2 = y * y; /* |y| <= pi / 4 */
    double sine = 1, cosine = 1;
    for (int k = 8; k > 0; k--) {
        sine = 1 - sine * y2 / (2 * k * (2 * k + 1));
        cosine = 1 - cosine * y2 / ((2 * k - 1) * 2 * k);
    }
    sine *= y;
    if (quarter == 0) return gp_complex(cosine, sine);
    if (quarter == 1) return gp_complex(-sine, cosine);
    if (quarter == -1) return gp_complex(sine, -cosine);
    return gp_complex(-cosine, -sine); /* or two NaN, where x is no finite number */
}

/* W_0 = (e^z - 1) / z and W_1 = 2 (W_0 - 1) / z - W_0, for |z| not small. */
static void first_two(GpComplex z, GpComplex *W) {
    W[0] = gp_cdiv(gp_expm1(z), z);
    W[1] = gp_csub(gp_cdiv(gp_cscale(2, gp_csub(W[0], gp_complex(1, 0))), z), W[0]);
}

/* Miller's algorithm: W_(k-1) = W_(k+1) - (2 k + 1) / (z / 2) W_k is stable downwards, up to a common factor. */
static void downwards(GpComplex z, GpComplex *W) {
    const GpComplex start[2] = {{0, 0}, {1e-300, 0}};
    GpComplex above = start[0], here = start[1], known[2], factor;
    int by_second;
    for (int k = GP_LEGENDRE + 24 + (int)gp_csize(z); k > 0; k--) {
        const GpComplex below = gp_csub(above, gp_cmul(gp_cdiv(gp_complex(2 * (2 * k + 1), 0), z), here));
        above = here;
        here = below;
        if (k <= GP_LEGENDRE) W[k - 1] = here;
        if (gp_csize(here) > 1e150) {
            above = gp_cscale(1e-290, above);
            here = gp_cscale(1e-290, here);
            for (int i = k - 1; i < GP_LEGENDRE; i++) W[i] = gp_cscale(1e-290, W[i]);
        }
    }
    known[0] = gp_cdiv(gp_expm1(z), z);
    by_second = gp_csize(z) > 2 && gp_csize(W[1]) > gp_csize(W[0]); /* W_0 vanishes at z = 2 pi i */
    if (by_second) first_two(z, known);
    factor = by_second ? gp_cdiv(known[1], W[1]) : gp_cdiv(known[0], W[0]);
    for (int k = 0; k < GP_LEGENDRE; k++) W[k] = gp_cmul(factor, W[k]);
}

void gp_legendre_integrals(GpComplex z, GpComplex *W) {
    for (int k = 0; k < GP_LEGENDRE; k++) W[k] = gp_complex(k == 0, 0);
    if (gp_csize(z) < 1e-12) { /* the next term is -z / 6 */
        W[0] = gp_complex(1 + z.re / 2, z.im / 2);
        W[1] = gp_cscale(-1.0 / 6, z);
    } else if (gp_csize(z) < 600) {
        downwards(z, W);
    } else { /* upwards is stable while k is far below |z| */
        first_two(z, W);
        for (int k = 1; k + 1 < GP_LEGENDRE; k++)
            W[k + 1] = gp_cadd(W[k - 1], gp_cmul(gp_cdiv(gp_complex(2 * (2 * k + 1), 0), z), W[k]));
    }
}

void gp_legendre_coefficients(const double *signal, double *c) {
    for (int k = 0; k < GP_LEGENDRE; k++) c[k] = 0;
    for (int j = 0; j < GP_LEGENDRE; j++) {
        const double x = 2 * gp_gauss_points[j] - 1, part = gauss_weights[j] * signal[j];
        double before = 0, P = 1;
        for (int k = 0; k < GP_LEGENDRE; k++) {
            const double next = ((2 * k + 1) * x * P - k * before) / (k + 1);
            c[k] += (2 * k + 1) * part * P;
            before = P;
            P = next;
        }
    }
}
