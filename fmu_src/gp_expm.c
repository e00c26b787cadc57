#include "gp_expm.h"

#include "gp_linalg.h"

/* Coefficients of the Pade approximant of degree 13 (Higham 2005, table 2.3). */
static const double b[14] = {64764752532480000.0, 32382376266240000.0, 7771770303897600.0, 1187353796428800.0,
                             129060195264000.0, 10559470521600.0, 670442572800.0, 33522128640.0,
                             1323241920.0, 40840800.0, 960960.0, 16380.0, 182.0, 1.0};

static double largest_column_sum(const GpExpm *w) {
    double largest = 0;
    for (size_t j = 0; j < w->n; j++) {
        double sum = 0;
        for (size_t i = 0; i < w->n; i++) sum += gp_magnitude(w->M[i * w->n + j]);
        if (!(sum <= largest)) largest = sum; /* keeps a NaN */
    }
    return largest;
}

static void product(const GpExpm *w, double *result, const double *X, const double *Y) {
    w->kernels->multiply(result, X, Y, w->n);
}

/* result (+)= c6 M6 + c4 M4 + c2 M2 + c0 I */
static void combine(const GpExpm *w, double *result, double c6, double c4, double c2, double c0, int add) {
    for (size_t i = 0; i < w->n * w->n; i++)
        result[i] = (add ? result[i] : 0.0) + ((c6 * w->M6[i] + c4 * w->M4[i]) + c2 * w->M2[i]);
    for (size_t i = 0; i < w->n; i++) result[i * w->n + i] += c0;
}

/* e^M - I to T1, for a matrix of norm below theta_13: (V - U) F = 2 U. */
static int pade13(GpExpm *w) {
    product(w, w->M2, w->M, w->M);
    product(w, w->M4, w->M2, w->M2);
    product(w, w->M6, w->M2, w->M4);

    combine(w, w->T1, b[13], b[11], b[9], 0, 0);
    product(w, w->T2, w->M6, w->T1);
    combine(w, w->T2, b[7], b[5], b[3], b[1], 1);
    product(w, w->T1, w->M, w->T2); /* U = M T2 */

    combine(w, w->T2, b[12], b[10], b[8], 0, 0);
    product(w, w->M, w->M6, w->T2); /* V */
    combine(w, w->M, b[6], b[4], b[2], b[0], 1);

    for (size_t i = 0; i < w->n * w->n; i++) {
        w->M[i] -= w->T1[i];
        w->T1[i] *= 2;
    }
    return gp_solve(w->M, w->n, w->T1, w->n, w->n, w->n);
}

double *gp_expm1_matrix(GpExpm *w) {
    const double theta = 5.371920351148152; /* the largest norm for which degree 13 reaches double precision */
    const double norm = largest_column_sum(w);
    const size_t size = w->n * w->n;
    double *F = w->T1, *G = w->T2, scale = 1;
    int squarings = 0;
    if (!gp_finite(norm)) return NULL;
    for (; norm * scale > theta; squarings++) scale *= 0.5;
    for (size_t i = 0; i < size; i++) w->M[i] *= scale;
    if (pade13(w)) return NULL;
    for (; squarings > 0; squarings--) { /* e^(2 M) - I = 2 F + F F */
        double *swap = F;
        product(w, G, F, F);
        for (size_t i = 0; i < size; i++) G[i] += 2 * F[i];
        F = G;
        G = swap;
    }
    for (size_t i = 0; i < size; i++)
        if (!gp_finite(F[i])) return NULL;
    return F;
}
