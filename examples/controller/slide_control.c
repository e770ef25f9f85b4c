/* A brake with slide protection as an FMU: speeds of the vehicle and of the wheel in, strength of the brake out.
 *
 * It knows nothing of the wheel's FMU. Every 10 ms it chooses to vent, hold or apply by the slide; between, the strength of the brake
 * follows its valve with a time constant. It counts its own time, so that its cycle is the same whatever the communication step.
 */
#include <math.h>
#include <stdlib.h>

enum { VELOCITY, OMEGA, DEMAND, RADIUS, TORQUE, COUNT }; /* value references */
enum { VENT = -1, HOLD, APPLY };
static const double CYCLE = 0.01, TIME_CONSTANT = 0.15; /* s */
static const double SLIDE_TO_VENT = 0.15, SLIDE_TO_APPLY = 0.08, OFF = 1.0; /* 1, 1, m/s: below it the brake only applies */

typedef struct {
    double value[COUNT];
    double until; /* s to the next choice */
    int valve;
} Brake;

static int choice(const Brake *it)
{
    double speed = fabs(it->value[VELOCITY]), slide = 1.0 - fabs(it->value[RADIUS] * it->value[OMEGA]) / fmax(speed, 1e-3);
    if (speed < OFF || slide < SLIDE_TO_APPLY) return APPLY;
    return slide > SLIDE_TO_VENT ? VENT : HOLD;
}

void *fmi2Instantiate(const char *name, int kind, const char *guid, const char *place, const void *callbacks, int visible, int log)
{
    Brake *it = calloc(1, sizeof(Brake));
    if (it) it->value[DEMAND] = 8000.0, it->value[RADIUS] = 0.46, it->valve = APPLY;
    return it;
}
int fmi2SetReal(void *one, const unsigned *which, size_t count, const double *values)
{
    for (size_t k = 0; k < count; k++) ((Brake *)one)->value[which[k]] = values[k];
    return 0;
}
int fmi2GetReal(void *one, const unsigned *which, size_t count, double *values)
{
    for (size_t k = 0; k < count; k++) values[k] = ((Brake *)one)->value[which[k]];
    return 0;
}
int fmi2DoStep(void *one, double time, double step, int back)
{
    Brake *it = one;
    while (step > 1e-9) {
        if (it->until < 1e-9) it->valve = choice(it), it->until = CYCLE;
        double part = fmin(step, it->until), target = it->valve == APPLY ? it->value[DEMAND] : 0.0;
        if (it->valve != HOLD) it->value[TORQUE] = target + (it->value[TORQUE] - target) * exp(-part / TIME_CONSTANT);
        step -= part, it->until -= part;
    }
    return 0;
}

const char *fmi2GetTypesPlatform(void) { return "default"; }
const char *fmi2GetVersion(void) { return "2.0"; }
void fmi2FreeInstance(void *one) { free(one); }
int fmi2SetupExperiment(void *one, int bounded, double tolerance, double start, int ends, double stop) { return 0; }
int fmi2EnterInitializationMode(void *one) { return 0; }
int fmi2ExitInitializationMode(void *one) { return 0; }
int fmi2Terminate(void *one) { return 0; }

/* The standard wants these functions; nothing calls them. */
#define ABSENT(name) int fmi2##name(void) { return 3; }
ABSENT(SetDebugLogging) ABSENT(Reset) ABSENT(GetInteger) ABSENT(GetBoolean) ABSENT(GetString) ABSENT(SetInteger) ABSENT(SetBoolean)
ABSENT(SetString) ABSENT(GetFMUstate) ABSENT(SetFMUstate) ABSENT(FreeFMUstate) ABSENT(SerializedFMUstateSize) ABSENT(SerializeFMUstate)
ABSENT(DeSerializeFMUstate) ABSENT(GetDirectionalDerivative) ABSENT(SetRealInputDerivatives) ABSENT(GetRealOutputDerivatives)
ABSENT(CancelStep) ABSENT(GetStatus) ABSENT(GetRealStatus) ABSENT(GetIntegerStatus) ABSENT(GetBooleanStatus) ABSENT(GetStringStatus)
