/* FMI 2.0 co-simulation: creation, initialisation, values and steps. */
#include "fmi2_slave.h"

#include <stdlib.h>
#include <string.h>

#include "gp_path.h"

const char *fmi2GetTypesPlatform(void) { return fmi2TypesPlatform; }
const char *fmi2GetVersion(void) { return fmi2Version; }

static Fmi2Slave *create(const char *name, const char *guid, const char *location,
                         const fmi2CallbackFunctions *functions, GpText *message) {
    GpModel model;
    Fmi2Slave *slave;
    FILE *stream = gp_open_resource(location, "model.bin", message);
    int failed;
    if (!stream) return NULL;
    failed = gp_model_read(&model, stream, message);
    fclose(stream);
    if (failed) return NULL;
    if (strcmp(model.guid, guid)) {
        gp_text_add(message, "The GUID does not belong to resources/model.bin; the FMU's files are mixed up.");
        gp_model_free(&model);
        return NULL;
    }
    slave = calloc(1, sizeof *slave);
    if (slave) slave->name = malloc(strlen(name) + 1);
    if (slave && slave->name) slave->core = gp_instance_create(&model, message);
    if (!slave || !slave->core) {
        if (!message->length) gp_text_add(message, "There is not enough memory for another instance.");
        if (slave) free(slave->name);
        free(slave);
        gp_model_free(&model);
        return NULL;
    }
    memcpy(slave->name, name, strlen(name) + 1);
    slave->logger = functions->logger;
    slave->environment = functions->componentEnvironment;
    slave->phase = INSTANTIATED;
    return slave;
}

fmi2Component fmi2Instantiate(fmi2String instanceName, fmi2Type fmuType, fmi2String fmuGUID,
                              fmi2String fmuResourceLocation, const fmi2CallbackFunctions *functions,
                              fmi2Boolean visible, fmi2Boolean loggingOn) {
    const char *name = instanceName ? instanceName : "";
    Fmi2Slave *slave = NULL;
    GpText message;
    (void)visible;
    if (!functions) return NULL;
    gp_text_clear(&message);
    if (!*name)
        gp_text_add(&message, "The instance name is missing.");
    else if (fmuType != fmi2CoSimulation)
        gp_text_add(&message, "This FMU supports co-simulation only.");
    else if (!fmuGUID)
        gp_text_add(&message, "The GUID is missing.");
    else if (!fmuResourceLocation)
        gp_text_add(&message, "The resource location is missing; the model is read from there.");
    else
        slave = create(name, fmuGUID, fmuResourceLocation, functions, &message);
    if (!slave) {
        fmi2_log(functions->logger, functions->componentEnvironment, name, fmi2Error, "logStatusError",
                 "fmi2Instantiate", message.text);
        return NULL;
    }
    slave->log = loggingOn ? LOG_ALL : 0;
    gp_clock_start(&slave->clock, 0, 0, 0, &message);
    return slave;
}

void fmi2FreeInstance(fmi2Component c) {
    Fmi2Slave *slave = c;
    if (!slave) return;
    gp_instance_free(slave->core);
    free(slave->name);
    free(slave);
}

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean toleranceDefined, fmi2Real tolerance,
                               fmi2Real startTime, fmi2Boolean stopTimeDefined, fmi2Real stopTime) {
    Fmi2Slave *slave = c;
    GpText message;
    (void)toleranceDefined; /* the steps are exact */
    (void)tolerance;
    if (!fmi2_allowed(c, INSTANTIATED, "fmi2SetupExperiment")) return fmi2Error;
    gp_text_clear(&message);
    if (gp_clock_start(&slave->clock, startTime, stopTimeDefined, stopTime, &message))
        return fmi2_fail(slave, "fmi2SetupExperiment", message.text);
    return fmi2OK;
}

fmi2Status fmi2EnterInitializationMode(fmi2Component c) {
    Fmi2Slave *slave = c;
    if (!fmi2_allowed(c, INSTANTIATED, "fmi2EnterInitializationMode")) return fmi2Error;
    slave->phase = INITIALISING;
    return fmi2OK;
}

fmi2Status fmi2ExitInitializationMode(fmi2Component c) {
    Fmi2Slave *slave = c;
    if (!fmi2_allowed(c, INITIALISING, "fmi2ExitInitializationMode")) return fmi2Error;
    if (gp_use_parameters(slave->core))
        return fmi2_fail(slave, "fmi2ExitInitializationMode", slave->core->message.text);
    slave->phase = STEPPING;
    return fmi2OK;
}

fmi2Status fmi2Terminate(fmi2Component c) {
    Fmi2Slave *slave = c;
    if (!fmi2_allowed(c, STEPPING, "fmi2Terminate")) return fmi2Error;
    slave->phase = TERMINATED;
    return fmi2OK;
}

fmi2Status fmi2Reset(fmi2Component c) {
    Fmi2Slave *slave = c;
    GpText message;
    if (!slave) return fmi2Error;
    gp_text_clear(&message);
    gp_instance_reset(slave->core);
    gp_clock_start(&slave->clock, 0, 0, 0, &message);
    slave->phase = INSTANTIATED;
    slave->last_step = fmi2OK;
    return fmi2OK;
}

fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, fmi2Real value[]) {
    Fmi2Slave *slave = c;
    if (!fmi2_allowed(c, INITIALISING | STEPPING | TERMINATED, "fmi2GetReal")) return fmi2Error;
    if (nvr && (!vr || !value)) return fmi2_fail(slave, "fmi2GetReal", "The references or values are missing.");
    if (gp_get(slave->core, vr, nvr, value)) return fmi2_fail(slave, "fmi2GetReal", slave->core->message.text);
    return fmi2OK;
}

fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference vr[], size_t nvr, const fmi2Real value[]) {
    Fmi2Slave *slave = c;
    if (!fmi2_allowed(c, INSTANTIATED | INITIALISING | STEPPING, "fmi2SetReal")) return fmi2Error;
    if (nvr && (!vr || !value)) return fmi2_fail(slave, "fmi2SetReal", "The references or values are missing.");
    if (gp_set(slave->core, vr, nvr, value)) return fmi2_fail(slave, "fmi2SetReal", slave->core->message.text);
    return fmi2OK;
}

fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t nvr,
                                       const fmi2Integer order[], const fmi2Real value[]) {
    Fmi2Slave *slave = c;
    if (!fmi2_allowed(c, INSTANTIATED | INITIALISING | STEPPING, "fmi2SetRealInputDerivatives")) return fmi2Error;
    if (nvr && (!vr || !order || !value))
        return fmi2_fail(slave, "fmi2SetRealInputDerivatives", "The references, orders or values are missing.");
    if (gp_set_slope(slave->core, vr, nvr, order, value))
        return fmi2_fail(slave, "fmi2SetRealInputDerivatives", slave->core->message.text);
    return fmi2OK;
}

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real currentCommunicationPoint, fmi2Real communicationStepSize,
                      fmi2Boolean noSetFMUStatePriorToCurrentPoint) {
    Fmi2Slave *slave = c;
    const double t = currentCommunicationPoint, h = communicationStepSize;
    unsigned long long formed;
    GpText message;
    (void)noSetFMUStatePriorToCurrentPoint;
    if (!fmi2_allowed(c, STEPPING, "fmi2DoStep")) return fmi2Error;
    slave->last_step = fmi2Error;
    gp_text_clear(&message);
    if (gp_clock_check(&slave->clock, t, h, &message)) return fmi2_fail(slave, "fmi2DoStep", message.text);
    formed = slave->core->formed;
    if (gp_step(slave->core, t + h, h)) return fmi2_fail(slave, "fmi2DoStep", slave->core->message.text);
    gp_clock_advance(&slave->clock, t, h);
    slave->last_step = fmi2OK;
    if (slave->log && slave->core->formed != formed)
        fmi2_log(slave->logger, slave->environment, slave->name, fmi2OK, "logEvents", "fmi2DoStep",
                 "The system was discretised for a new step size or new parameters.");
    return fmi2OK;
}
