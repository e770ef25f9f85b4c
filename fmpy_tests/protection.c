/* Slide protection of one's own as an FMU: vents an axle whose speed is below nine tenths of the fastest one. */
#include <stdlib.h>

enum { AXLES = 4 };
typedef struct { double speed[AXLES], valve[AXLES]; } Protection;
typedef unsigned int Reference; /* 0 to 3: speeds [m/s]; 4 to 7: valves, 0 apply, 1 hold, 2 vent */

const char *fmi2GetTypesPlatform(void) { return "default"; }
const char *fmi2GetVersion(void) { return "2.0"; }
void *fmi2Instantiate(const char *name, int kind, const char *guid, const char *place, const void *callbacks, int visible, int log)
{
    return calloc(1, sizeof(Protection));
}
void fmi2FreeInstance(void *one) { free(one); }
int fmi2EnterInitializationMode(void *one) { return 0; }
int fmi2ExitInitializationMode(void *one) { return 0; }
int fmi2Terminate(void *one) { return 0; }
int fmi2SetReal(void *one, const Reference *which, size_t count, const double *values)
{
    for (size_t k = 0; k < count; k++) ((Protection *)one)->speed[which[k]] = values[k];
    return 0;
}
int fmi2GetReal(void *one, const Reference *which, size_t count, double *values)
{
    for (size_t k = 0; k < count; k++) values[k] = ((Protection *)one)->valve[which[k] - AXLES];
    return 0;
}
int fmi2DoStep(void *one, double time, double step, int back)
{
    Protection *it = one;
    double fastest = 0.0;
    for (int k = 0; k < AXLES; k++) fastest = it->speed[k] > fastest ? it->speed[k] : fastest;
    for (int k = 0; k < AXLES; k++) it->valve[k] = fastest > 1.0 && it->speed[k] < 0.9 * fastest ? 2.0 : 0.0;
    return 0;
}

/* The standard wants these functions; nothing calls them. */
#define ABSENT(name) int fmi2##name(void) { return 3; }
ABSENT(SetDebugLogging) ABSENT(SetupExperiment) ABSENT(Reset) ABSENT(GetInteger) ABSENT(GetBoolean) ABSENT(GetString)
ABSENT(SetInteger) ABSENT(SetBoolean) ABSENT(SetString) ABSENT(GetFMUstate) ABSENT(SetFMUstate) ABSENT(FreeFMUstate)
ABSENT(SerializedFMUstateSize) ABSENT(SerializeFMUstate) ABSENT(DeSerializeFMUstate) ABSENT(GetDirectionalDerivative)
ABSENT(SetRealInputDerivatives) ABSENT(GetRealOutputDerivatives) ABSENT(CancelStep) ABSENT(GetStatus)
ABSENT(GetRealStatus) ABSENT(GetIntegerStatus) ABSENT(GetBooleanStatus) ABSENT(GetStringStatus)
