#include "gp_clock.h"

#include "gp_linalg.h"

double gp_clock_jitter(double t, double h) {
    const double scale = gp_magnitude(t) > gp_magnitude(h) ? gp_magnitude(t) : gp_magnitude(h);
    return 8 * 2.220446049250313e-16 * scale;
}

int gp_clock_start(GpClock *c, double start, int has_stop, double stop, GpText *message) {
    if (!gp_finite(start) || (has_stop && !gp_finite(stop))) {
        gp_text_add(message, "The start time and the stop time must be finite.");
        return -1;
    }
    if (has_stop && stop < start) {
        gp_text_add(message, "The stop time ");
        gp_text_real(message, stop);
        gp_text_add(message, " s lies before the start time ");
        gp_text_real(message, start);
        gp_text_add(message, " s.");
        return -1;
    }
    c->time = start;
    c->has_stop = has_stop;
    c->stop = has_stop ? stop : 0;
    return 0;
}

int gp_clock_check(const GpClock *c, double t, double h, GpText *message) {
    if (!gp_finite(h) || h <= 0) {
        gp_text_add(message, "The step size must be positive and finite, but is ");
        gp_text_real(message, h);
        gp_text_add(message, " s.");
        return -1;
    }
    if (!gp_finite(t) || gp_magnitude(t - c->time) > 1e-6 * h + gp_clock_jitter(t, h)) {
        gp_text_add(message, "The step starts at ");
        gp_text_real(message, t);
        gp_text_add(message, " s, but the last step ended at ");
        gp_text_real(message, c->time);
        gp_text_add(message, " s.");
        return -1;
    }
    if (c->has_stop && t + h > c->stop + 1e-6 * h + gp_clock_jitter(t, h)) {
        gp_text_add(message, "The step ends at ");
        gp_text_real(message, t + h);
        gp_text_add(message, " s, after the stop time ");
        gp_text_real(message, c->stop);
        gp_text_add(message, " s.");
        return -1;
    }
    return 0;
}

void gp_clock_advance(GpClock *c, double t, double h) {
    c->time = t + h;
}
