#include "gp_source.h"

#include "gp_linalg.h"
#include "gp_waves.h"

static const double TWO_PI = 6.283185307179586476925286766559;
/* 1 / (2 pi) in two doubles: large phases keep their place in the circle */
static const double PER_RADIAN = 0.15915494309189535, PER_RADIAN_REST = -9.839338337591243e-18;
static const double RESOLVED = 1.5; /* rad of a tone within a step: 12 Legendre polynomials miss 1e-14 of it */

double gp_source_order(const GpSource *s, const GpModel *m, size_t i) {
    return m->tone[i].harmonic * s->teeth + m->tone[i].shift;
}

static double whole_part(double x) { /* floor; larger doubles than 2^62 are whole */
    double whole;
    if (!(gp_magnitude(x) < 4.6e18)) return x;
    whole = (double)(long long)x;
    return whole > x ? whole - 1 : whole;
}

typedef struct {
    double high, low; /* a number of about 32 digits is their sum */
} Exact;

static Exact exact_sum(double a, double b) { /* Knuth */
    Exact r;
    double shown;
    r.high = a + b;
    shown = r.high - a;
    r.low = (a - (r.high - shown)) + (b - shown);
    return r;
}

static Exact exact_product(double a, double b) { /* Dekker */
    const double split = 134217729.0; /* 2^27 + 1 */
    Exact r = {a * b, 0};
    double a_high, b_high, a_low, b_low;
    if (!(gp_magnitude(a) < 1e150) || !(gp_magnitude(b) < 1e150)) return r;
    a_high = split * a - (split * a - a);
    b_high = split * b - (split * b - b);
    a_low = a - a_high;
    b_low = b - b_high;
    r.low = ((a_high * b_high - r.high) + a_high * b_low + a_low * b_high) + a_low * b_low;
    return r;
}

/* Of a times b, less whole numbers. */
static double fraction(double a, double b) {
    const Exact product = exact_product(a, b);
    return product.high - whole_part(product.high) + product.low;
}

/* Cycles of tone i at present, less whole ones. */
static double cycles(const GpSource *s, const GpModel *m, size_t i) {
    const double past = fraction(m->tone[i].harmonic * s->teeth, s->turns) + fraction(m->tone[i].shift, s->turns);
    return past + gp_source_order(s, m, i) * (s->part + s->rest) +
           (fraction(s->phase[i], PER_RADIAN) + s->phase[i] * PER_RADIAN_REST);
}

double gp_source_value(const GpSource *s, const GpModel *m) {
    double e = 0;
    for (size_t i = 0; i < m->tones; i++)
        if (s->amplitude[i] != 0) e += s->amplitude[i] * gp_turn(cycles(s, m, i)).re;
    return e;
}

double gp_source_rate(const GpSource *s, const GpModel *m) {
    double rate = 0;
    for (size_t i = 0; i < m->tones; i++)
        if (s->amplitude[i] != 0)
            rate -= s->amplitude[i] * gp_source_order(s, m, i) * gp_turn(cycles(s, m, i)).im;
    return rate;
}

double gp_source_tangent(const GpSource *s, const GpModel *m, const double *amplitude, const double *phase,
                         double teeth) {
    const double angle = gp_source_angle(s);
    double change = 0;
    for (size_t i = 0; i < m->tones; i++) {
        const GpComplex wave = gp_turn(cycles(s, m, i));
        change += amplitude[i] * wave.re - s->amplitude[i] * wave.im * (phase[i] + teeth * m->tone[i].harmonic * angle);
    }
    return change;
}

size_t gp_source_substeps(const GpSource *s, const GpModel *m, double h) {
    const double before = gp_magnitude(s->speed), after = gp_magnitude(s->speed + h * s->speed_slope);
    double largest = 0, turned;
    int on = 0;
    for (size_t i = 0; i < m->tones; i++) {
        const double order = gp_magnitude(gp_source_order(s, m, i));
        if (s->amplitude[i] == 0) continue;
        on = 1;
        if (order > largest) largest = order;
    }
    turned = TWO_PI * largest * (before > after ? before : after) / 60 * h;
    if (!on) return 0;
    if (!(turned < RESOLVED * 1e6)) return GP_NONE;
    return 1 + (size_t)(turned / RESOLVED);
}

void gp_source_coefficients(const GpSource *s, const GpModel *m, double t, double h, double *coefficients) {
    double signal[GP_LEGENDRE] = {0}, revolutions[GP_LEGENDRE];
    for (int j = 0; j < GP_LEGENDRE; j++) {
        const double at = t + h * gp_gauss_points[j];
        revolutions[j] = (s->speed * at + 0.5 * s->speed_slope * at * at) / 60;
    }
    for (size_t i = 0; i < m->tones; i++) {
        const double order = gp_source_order(s, m, i), start = cycles(s, m, i);
        if (s->amplitude[i] == 0) continue;
        for (int j = 0; j < GP_LEGENDRE; j++)
            signal[j] += s->amplitude[i] * gp_turn(start + order * revolutions[j]).re;
    }
    gp_legendre_coefficients(signal, coefficients);
}

/* Revolutions over a step h: (speed h + slope h^2 / 2) / 60. */
static Exact revolutions_over(const GpSource *s, double h) {
    const Exact steady = exact_product(s->speed, h), gained = exact_product(0.5 * s->speed_slope * h, h);
    const Exact sum = exact_sum(steady.high, gained.high);
    Exact r, back;
    r.high = sum.high / 60;
    back = exact_product(r.high, 60);
    r.low = (((sum.high - back.high) - back.low) + sum.low + steady.low + gained.low) / 60;
    return r;
}

int gp_source_can_advance(const GpSource *s, double h) {
    return gp_finite(s->turns + revolutions_over(s, h).high) && gp_finite(s->speed + h * s->speed_slope);
}

/* Takes part + rest + more into turns, part and rest. */
static void turn_on(GpSource *s, Exact more) {
    const Exact sum = exact_sum(s->part, more.high), part = exact_sum(sum.high, sum.low + (s->rest + more.low));
    const double whole = whole_part(part.high);
    const Exact rest = exact_sum(part.high, -whole);
    s->turns += whole;
    s->part = rest.high;
    s->rest = part.low + rest.low;
}

void gp_source_advance(GpSource *s, double h) {
    turn_on(s, revolutions_over(s, h));
    s->speed += h * s->speed_slope;
    s->speed_slope = 0;
}

double gp_source_angle(const GpSource *s) { return TWO_PI * (s->turns + s->part) + TWO_PI * s->rest; }

void gp_source_turn_to(GpSource *s, double angle) {
    const double revolutions = angle / TWO_PI;
    s->turns = whole_part(revolutions);
    s->part = revolutions - s->turns;
    s->rest = 0;
    s->rest = (angle - gp_source_angle(s)) / TWO_PI; /* so that the angle is read as it was set */
    if (!gp_finite(s->rest)) s->rest = 0;
}
