#include "gp_model_check.h"

#include "gp_given.h"
#include "gp_linalg.h"
#include "gp_schedule.h"

static int all_finite(const double *first, const double *end) {
    for (; first < end; first++)
        if (!gp_finite(*first)) return 0;
    return 1;
}

static int numbers_are_good(const GpModel *m) {
    /* the doubles stand one behind another, from the eigenvalues to the units */
    if (!all_finite(m->eigenvalues, m->unit + (gp_is_given(m) ? m->order + m->loads : 0))) return 0;
    if (gp_is_given(m) ? m->frequency != 0 : !(m->frequency > 0)) return 0;
    if (!gp_finite(m->frequency) || !gp_finite(m->speed) || !gp_finite(m->teeth)) return 0;
    if (!gp_finite(m->start_torque)) return 0;
    for (size_t r = 0; r < m->modes; r++) {
        if (m->eigenvalues[r] < 0 || !(m->scale[r] > 0) || !(m->nominal[r] > 0)) return 0;
    }
    for (size_t i = 0; i < m->groups; i++)
        if (m->zeta[i] < 0 || m->zeta[i] >= 1) return 0;
    for (size_t i = 0; i < m->groups * m->modes; i++)
        if (m->share[i] < 0) return 0;
    for (size_t i = 0; i < m->loads; i++)
        if (m->is_error[i] > 1) return 0;
    for (size_t i = 0; i < m->rows; i++)
        if (m->rotation[i] > 1) return 0;
    return 1;
}

static int pairs_are_good(const GpModel *m) {
    for (size_t k = 0; k < m->pairs; k++) {
        const GpPole *p = m->pole + k;
        if (m->pair_kind[k] >= GP_PAIR_KINDS) return 0;
        if (m->pair_kind[k] == GP_OSCILLATING ? p->norm_re == 0 && p->norm_im == 0
                                              : p->norm_re == 0 || p->norm_im == 0)
            return 0;
    }
    return 1;
}

static int source_is_good(const GpModel *m) {
    if (m->source_load == GP_NONE) return 1;
    if (!m->is_error[m->source_load] || !(m->teeth >= 1 && m->teeth <= 1e6)) return 0;
    if (m->teeth != (double)(long)m->teeth) return 0;
    for (size_t i = 0; i < m->tones; i++)
        if (!(m->tone[i].harmonic >= 1 && m->tone[i].harmonic <= 1e4) || !(gp_magnitude(m->tone[i].shift) <= 1e6))
            return 0;
    return 1;
}

static int joints_are_good(const GpModel *m, size_t text_size) {
    size_t row = 0, block = 0;
    for (size_t i = 0; i < m->joints; i++) {
        const GpJoint *j = m->joint + i;
        const size_t d = j->size;
        if (j->first != row || j->block != block || d == 0 || d > 6 || j->path > 1) return 0;
        if (j->name >= text_size || row + d > m->rows || block + d * d > m->blocks) return 0;
        for (size_t k = 0; k < d * d; k++) {
            const size_t mirror = block + k % d * d + k / d;
            if (m->stiffness[block + k] != m->stiffness[mirror] || m->damping[block + k] != m->damping[mirror])
                return 0;
        }
        row += d;
        block += d * d;
    }
    return row == m->rows && block == m->blocks;
}

static int outputs_are_good(const GpModel *m) {
    for (size_t i = 0; i < m->outputs; i++) {
        const GpOutput *o = m->output + i;
        const int of_joint = o->quantity == GP_FORCE || o->quantity == GP_POWER;
        if (o->quantity >= GP_QUANTITIES || o->zero || (o->quantity == GP_ROW) != gp_is_given(m)) return 0;
        if (of_joint ? o->joint >= m->joints || o->dof >= m->joint[o->joint].size
                     : o->joint != GP_NONE || o->dof != 0)
            return 0;
    }
    return 1;
}

static int variable_is_good(const GpModel *m, const GpVariable *v) {
    const int alone = !v->b && !v->c;
    switch (v->kind) {
    case GP_INPUT: return v->a < m->loads && alone;
    case GP_SPEED:
    case GP_TEETH: return m->source_load != GP_NONE && !v->a && alone;
    case GP_STIFFNESS:
    case GP_DAMPING: return v->a < m->joints && v->b <= v->c && v->c < m->joint[v->a].size;
    case GP_MODAL_DAMPING: return v->a < m->groups && alone;
    case GP_TORQUE: return m->points && !v->a && alone;
    case GP_TONE_AMPLITUDE:
    case GP_TONE_PHASE:
    case GP_ORDER_FREQUENCY:
    case GP_ORDER_ALPHA:
    case GP_ORDER_POWER: return v->a < m->tones && alone;
    case GP_OUTPUT: return v->a < m->outputs && alone;
    case GP_ALPHA: return !gp_is_given(m) && v->a < 3 && alone;
    case GP_JOINT_ALPHA:
    case GP_STIFFNESS_MATRIX:
    case GP_DAMPING_MATRIX:
    case GP_PORT_FORCES:
    case GP_PORT_VELOCITIES: return v->a < m->joints && alone;
    case GP_FRF_REAL:
    case GP_FRF_IMAG: return !gp_is_given(m) && v->a < m->outputs && m->output[v->a].quantity != GP_POWER && alone;
    case GP_STATE:
    case GP_DERIVATIVE: return v->a < m->states && alone;
    case GP_FREQUENCY: return !gp_is_given(m) && !v->a && alone;
    case GP_TIME:
    case GP_STATES:
    case GP_DERIVATIVES:
    case GP_MATRIX_A:
    case GP_MATRIX_B:
    case GP_MATRIX_C:
    case GP_MATRIX_D: return !v->a && alone;
    default: return 0; /* ports and matrix entries come as whole arrays only */
    }
}

const char *gp_model_check(const GpModel *m, size_t text_size) {
    if (!text_size || m->text[text_size - 1]) return "its text is not terminated.";
    if (!numbers_are_good(m)) return "a number is out of range.";
    if (gp_given_check(m)) return gp_given_check(m);
    if (!joints_are_good(m, text_size)) return "a joint is wrong.";
    if (gp_schedule_check(m)) return gp_schedule_check(m);
    if (!outputs_are_good(m)) return "an output is wrong.";
    if (!pairs_are_good(m)) return "a mode of the coupled system is wrong.";
    if (!source_is_good(m)) return "the gear mesh source is wrong.";
    for (size_t i = 0; i < m->variables; i++) {
        const GpVariable *v = m->variable + i;
        if (v->name >= text_size || v->zero || !variable_is_good(m, v)) return "a variable is wrong.";
    }
    return NULL;
}
