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
        for (size_t i = 0; i < w->n; i++) {
            const double a = w->M[i * w->width + j];
            sum += a < 0 ? -a : a;
        }
        if (!(sum <= largest)) largest = sum; /* keeps a NaN */
    }
    return largest;
}

/* result = (top left block of X) * Y. The lower rows of Y, where they matter, are added by the caller. */
static void product(const GpExpm *w, double *result, const double *X, const double *Y) {
    gp_multiply(result, w->width, X, w->width, Y, w->width, w->n, w->n, w->width, 0);
}

/* result += S N: S is the right part [S0 S1] of the wide matrix X and N = sigma [0 I; 0 0]. */
static void add_shifted(const GpExpm *w, double *result, double sigma, const double *X) {
    for (size_t i = 0; i < w->n; i++)
        gp_axpy(result + i * w->width + w->n + w->m, sigma, X + i * w->width + w->n, w->m);
}

static void combine(const GpExpm *w, double *result, double c6, double c4, double c2, int add) {
    for (size_t i = 0; i < w->n * w->width; i++)
        result[i] = (add ? result[i] : 0.0) + ((c6 * w->M6[i] + c4 * w->M4[i]) + c2 * w->M2[i]);
}

static void add_identity(const GpExpm *w, double *result, double c) {
    for (size_t i = 0; i < w->n; i++) result[i * w->width + i] += c;
}

/* expm(M) - I to T1 for a matrix of norm below theta_13, whose lower right block is N = sigma [0 I; 0 0].
   N N = 0, so every even power has a zero lower block and the odd part has b1 I in place of it. */
static int pade13(GpExpm *w, double sigma) {
    const size_t size = w->n * w->width;
    product(w, w->M2, w->M, w->M);
    add_shifted(w, w->M2, sigma, w->M);
    product(w, w->M4, w->M2, w->M2);
    product(w, w->M6, w->M2, w->M4);

    combine(w, w->T1, b[13], b[11], b[9], 0);
    product(w, w->T2, w->M6, w->T1);
    combine(w, w->T2, b[7], b[5], b[3], 1);
    add_identity(w, w->T2, b[1]);
    product(w, w->T1, w->M, w->T2); /* U = M T2 */
    for (size_t i = 0; i < w->n; i++)
        gp_axpy(w->T1 + i * w->width + w->n, b[1], w->M + i * w->width + w->n, 2 * w->m);

    combine(w, w->T2, b[12], b[10], b[8], 0);
    product(w, w->M, w->M6, w->T2); /* V */
    combine(w, w->M, b[6], b[4], b[2], 1);
    add_identity(w, w->M, b[0]);

    /* (V - U) F = 2 U with F = expm - I: subtracting the identity before squaring, not after, keeps the slow
       modes of a stiff system accurate (they are small numbers beside it). */
    for (size_t i = 0; i < size; i++) {
        w->M[i] -= w->T1[i];
        w->T1[i] *= 2;
    }
    add_shifted(w, w->T1, -sigma, w->M);
    return gp_solve(w->M, w->width, w->T1, w->width, w->n, w->width);
}

int gp_discretise(GpExpm *w, double h, double *result) {
    const double theta = 5.371920351148152; /* the largest norm for which degree 13 reaches double precision */
    const size_t n = w->n, size = w->n * w->width;
    const double norm = largest_column_sum(w) * h;
    double sigma = 1, *F = w->T1, *G = w->T2;
    int squarings = 0;
    if (!gp_finite(norm)) return -1;
    while (norm * sigma > theta) {
        sigma *= 0.5;
        squarings++;
    }
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < w->width; j++)
            w->M[i * w->width + j] = j < n + w->m ? w->M[i * w->width + j] * (h * sigma) : 0.0;
    if (pade13(w, sigma)) return -1;
    for (; squarings > 0; squarings--) { /* expm(2 M) - I = 2 F + F F */
        double *swap = F;
        product(w, G, F, F);
        add_shifted(w, G, sigma, F);
        for (size_t i = 0; i < size; i++) G[i] += 2 * F[i];
        sigma *= 2;
        F = G;
        G = swap;
    }
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < w->width; j++) {
            const double value = F[i * w->width + j];
            if (!gp_finite(value)) return -1;
            result[j * n + i] = value;
        }
    return 0;
}
