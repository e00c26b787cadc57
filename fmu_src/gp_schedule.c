#include "gp_schedule.h"

#include "gp_instance.h"
#include "gp_linalg.h"

double gp_schedule_clamped(const GpModel *m, double torque) {
    const double *T = m->torque;
    if (!m->points) return 0;
    if (!(torque > T[0])) return T[0];
    return torque < T[m->points - 1] ? torque : T[m->points - 1];
}

/* The last point that is not above the torque, but not the last of all. */
static size_t segment(const GpModel *m, double torque) {
    size_t low = 0, high = m->points - 1;
    while (high - low > 1) {
        const size_t middle = low + (high - low) / 2;
        if (m->torque[middle] <= torque)
            low = middle;
        else
            high = middle;
    }
    return low;
}

typedef struct {
    const double *low, *high; /* the tables at the ends of the segment */
    double share;             /* of the upper end */
} Place;

static Place find(const GpModel *m, const double *table, double torque) {
    const double *T = m->torque, used = gp_schedule_clamped(m, torque);
    const size_t i = segment(m, used);
    Place p;
    p.low = table + i * m->blocks;
    p.high = p.low + m->blocks;
    p.share = (used - T[i]) / (T[i + 1] - T[i]);
    return p;
}

/* A convex combination, so that it is positive semidefinite as the two are. */
static double between(const Place *p, size_t at) { return (1 - p->share) * p->low[at] + p->share * p->high[at]; }

/* The entries of joint j that follow in this way: their number, 0 where it does not. */
static size_t following(const GpModel *m, size_t j, uint32_t flag) {
    const size_t d = m->joint[j].size;
    return m->joint[j].follows & flag ? d * d : 0;
}

/* Writes one kind of matrices; `start`: what the model begins with, which is taken over bit by bit. */
static void write(const GpModel *m, double torque, uint32_t flag, const double *table, const double *start,
                  double *packed) {
    const Place p = find(m, table, torque);
    const int begins = gp_schedule_clamped(m, torque) == m->start_torque;
    for (size_t j = 0; j < m->joints; j++)
        for (size_t k = 0; k < following(m, j, flag); k++) {
            const size_t at = m->joint[j].block + k;
            packed[at] = begins ? start[at] : between(&p, at);
        }
}

void gp_schedule_matrices(const GpModel *m, double torque, double *K, double *C) {
    if (!m->points) return;
    write(m, torque, GP_FOLLOWS_STIFFNESS, m->stiffness_at, m->stiffness, K);
    write(m, torque, GP_FOLLOWS_DAMPING, m->damping_at, m->damping, C);
}

static int agrees(const GpModel *m, double torque, uint32_t flag, const double *table, const double *start,
                  const double *packed) {
    const Place p = find(m, table, torque);
    const int begins = gp_schedule_clamped(m, torque) == m->start_torque;
    for (size_t j = 0; j < m->joints; j++)
        for (size_t k = 0; k < following(m, j, flag); k++) {
            const size_t at = m->joint[j].block + k;
            if (packed[at] != (begins ? start[at] : between(&p, at))) return 0;
        }
    return 1;
}

int gp_schedule_agrees(const GpModel *m, double torque, const double *K, const double *C) {
    return !m->points || (agrees(m, torque, GP_FOLLOWS_STIFFNESS, m->stiffness_at, m->stiffness, K) &&
                          agrees(m, torque, GP_FOLLOWS_DAMPING, m->damping_at, m->damping, C));
}

void gp_schedule_tangent(const GpModel *m, double torque, double change, double *dK, double *dC) {
    const double *T = m->torque;
    double rate;
    size_t i;
    if (!m->points || torque < T[0] || torque >= T[m->points - 1]) return;
    i = segment(m, torque);
    rate = change / (T[i + 1] - T[i]);
    for (size_t j = 0; j < m->joints; j++) {
        const size_t first = m->joint[j].block, row = i * m->blocks + first;
        for (size_t k = 0; k < following(m, j, GP_FOLLOWS_STIFFNESS); k++)
            dK[first + k] += rate * (m->stiffness_at[row + m->blocks + k] - m->stiffness_at[row + k]);
        for (size_t k = 0; k < following(m, j, GP_FOLLOWS_DAMPING); k++)
            dC[first + k] += rate * (m->damping_at[row + m->blocks + k] - m->damping_at[row + k]);
    }
}

int gp_schedule_decides(const GpModel *m, const GpVariable *v) {
    switch (v->kind) {
    case GP_STIFFNESS:
    case GP_STIFFNESS_MATRIX: return (m->joint[v->a].follows & GP_FOLLOWS_STIFFNESS) != 0;
    case GP_DAMPING:
    case GP_DAMPING_MATRIX: return (m->joint[v->a].follows & GP_FOLLOWS_DAMPING) != 0;
    default: return 0;
    }
}

/* Symmetric, with no negative entry on the diagonal where the joint follows, and all zero where it does not. */
static int table_is_good(const GpModel *m, uint32_t flag, const double *table) {
    for (size_t i = 0; i < m->points; i++)
        for (size_t j = 0; j < m->joints; j++) {
            const size_t d = m->joint[j].size;
            const double *A = table + i * m->blocks + m->joint[j].block;
            for (size_t k = 0; k < d * d; k++) {
                if (!(m->joint[j].follows & flag) && A[k] != 0) return 0;
                if (A[k] != A[k % d * d + k / d] || (k % d == k / d && A[k] < 0)) return 0;
            }
        }
    return 1;
}

/* Whether the model begins with what the table gives there, up to rounding. */
static int begins_well(const GpModel *m, uint32_t flag, const double *table, const double *start) {
    const Place p = find(m, table, m->start_torque);
    for (size_t j = 0; j < m->joints; j++)
        for (size_t k = 0; k < following(m, j, flag); k++) {
            const size_t at = m->joint[j].block + k;
            const double size = gp_magnitude(p.low[at]) + gp_magnitude(p.high[at]);
            if (!(gp_magnitude(start[at] - between(&p, at)) <= 1e-12 * size)) return 0;
        }
    return 1;
}

const char *gp_schedule_check(const GpModel *m) {
    static const char wrong[] = "the schedule over the torque is wrong.";
    size_t count = 0;
    for (size_t j = 0; j < m->joints; j++) {
        const uint32_t follows = m->joint[j].follows;
        if (follows > 3 || follows == GP_FOLLOWS_DAMPING) return wrong;
        count += follows != 0;
    }
    if (!m->points) return count || m->start_torque != 0 ? wrong : NULL;
    if (m->points < 2 || !count || gp_schedule_clamped(m, m->start_torque) != m->start_torque) return wrong;
    for (size_t i = 1; i < m->points; i++) /* also: the distances are numbers that can be divided by */
        if (!(m->torque[i] > m->torque[i - 1]) || !gp_finite(1 / (m->torque[i] - m->torque[i - 1])) ||
            !gp_finite(m->torque[i] - m->torque[i - 1]))
            return wrong;
    if (!table_is_good(m, GP_FOLLOWS_STIFFNESS, m->stiffness_at) || !table_is_good(m, GP_FOLLOWS_DAMPING, m->damping_at))
        return wrong;
    return begins_well(m, GP_FOLLOWS_STIFFNESS, m->stiffness_at, m->stiffness) &&
                   begins_well(m, GP_FOLLOWS_DAMPING, m->damping_at, m->damping)
               ? NULL
               : wrong;
}

void gp_set_torque(GpInstance *p, double torque) {
    const GpModel *m = &p->model;
    const int same = gp_schedule_clamped(m, torque) == gp_schedule_clamped(m, p->torque);
    p->torque = torque;
    if (same) return; /* importers may set all inputs at every step */
    gp_schedule_matrices(m, torque, p->K, p->C);
    for (size_t j = 0; j < m->joints; j++)
        if (m->joint[j].follows) p->changed[j] = 1;
}
