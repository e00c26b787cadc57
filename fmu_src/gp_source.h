#ifndef GP_SOURCE_H
#define GP_SOURCE_H
/* The gear mesh source: a transmission error made of tones that turn with the driving shaft,
       e = sum a_i cos(o_i theta + phi_i),   theta' = 2 pi n / 60,   o_i = harmonic_i * teeth + shift_i,
   n the shaft speed in rev/min. Tones with a shift are the sidebands of a modulated harmonic. */
#include "gp_model.h"

#define GP_RAD_PER_REV_MIN 0.10471975511965977462 /* (2 pi / 60) rad/s per rev/min */

typedef struct {
    double *amplitude; /* (tones) m */
    double *phase;     /* (tones) rad */
    double teeth;      /* of the gear on the driving shaft */
    double speed;      /* rev/min */
    double speed_slope; /* rev/min per s, over the coming step */
    /* the angle, in three parts so that a million revolutions lose no digits of its phase */
    double turns;      /* whole revolutions made */
    double part;       /* of the present revolution, 0 ... 1 */
    double rest;       /* what rounding leaves of `part` */
} GpSource;

/* Orders of the driving shaft that tone i is. */
double gp_source_order(const GpSource *s, const GpModel *m, size_t i);

/* The transmission error at present. */
double gp_source_value(const GpSource *s, const GpModel *m);

/* Its derivatives: with respect to the angle (m/rad), and along a direction of amplitudes, phases and tooth count. */
double gp_source_rate(const GpSource *s, const GpModel *m);
double gp_source_tangent(const GpSource *s, const GpModel *m, const double *amplitude, const double *phase,
                         double teeth);

/* Steps of equal length that a step h falls into, so that Legendre polynomials resolve every tone; 0 where the
   source is off, or GP_NONE where they would be too many. */
size_t gp_source_substeps(const GpSource *s, const GpModel *m, double h);

/* Legendre coefficients of e over the step from t to t + h after the present time. */
void gp_source_coefficients(const GpSource *s, const GpModel *m, double t, double h, double *coefficients);

/* Whether the speed and the angle stay finite over a step h. */
int gp_source_can_advance(const GpSource *s, double h);

/* Turns the shaft on over a step h, and ends the slope of the speed. */
void gp_source_advance(GpSource *s, double h);

double gp_source_angle(const GpSource *s); /* theta, rad */
void gp_source_turn_to(GpSource *s, double angle);

#endif
