/* A small master in C for Linux and Windows: loads the library of the FMU, brakes a wheel in 2,000 steps and prints outputs.
 *
 *     host LIBRARY IDENTITY RESOURCES REFERENCE[:SIZE]...
 *
 * Compiled with -DFMI=3 it is a master of FMI 3.0, otherwise of FMI 2.0. IDENTITY: GUID or instantiation token of
 * modelDescription.xml. RESOURCES: of the extracted FMU, a URI in FMI 2.0 and a path in FMI 3.0. REFERENCE: value references
 * of the real outputs to print, of arrays with their size. Every 20th step prints one line, `step value value ...`, with 17 significant digits, so that no bit
 * is lost. After step 1,000 the state is saved, 200 steps are done, the state is restored and the same steps are done
 * again: the host ends with an error unless all outputs are equal bit for bit. The time of the steps goes to standard
 * error. Inputs are made with sums and products only, so that they are the same on every system.
 */
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#ifdef _WIN32
#include <windows.h>
static void *open_library(const char *path) { return (void *)LoadLibraryA(path); }
static void *find(void *library, const char *name) { return (void *)GetProcAddress((HMODULE)library, name); }
static int close_library(void *library) { return FreeLibrary((HMODULE)library) ? 0 : -1; }
#else
#include <dlfcn.h>
static void *open_library(const char *path) { return dlopen(path, RTLD_NOW | RTLD_LOCAL); }
static void *find(void *library, const char *name) { return dlsym(library, name); }
static int close_library(void *library) { return dlclose(library); }
#endif

enum { STEPS = 2000, SAVED = 1000, REPEATED = 200, PRINTED = 20 };
static const double STEP = 1e-3; /* s */
static const unsigned DRIVE_MOMENT = 201, DRIVE_LOAD = 204; /* value references, N m and N */

typedef void *Component, *State;
typedef int Plain(Component);
typedef void Free(Component);
typedef int OnState(Component, State *);
typedef int SetState(Component, State);

static void *library;
static Component wheel;

static void fail(const char *what) {
    fprintf(stderr, "host: %s failed\n", what);
    exit(1);
}

/* The function of that name. */
static void *function(const char *name) {
    void *found = find(library, name);
    if (!found) fail(name);
    return found;
}

static void call(const char *name) {
    if (((Plain *)function(name))(wheel) != 0) fail(name);
}

#if FMI == 3

#include <stdbool.h>
#include <stdint.h>

typedef void Logger(void *, int, const char *, const char *);
typedef Component Instantiate(const char *, const char *, const char *, bool, bool, bool, bool, const uint32_t *, size_t, void *,
                              Logger *, void (*)(void));
typedef int Initialize(Component, bool, double, double, bool, double);
typedef int SetValues(Component, const uint32_t *, size_t, const double *, size_t);
typedef int GetValues(Component, const uint32_t *, size_t, double *, size_t);
typedef int DoStep(Component, double, double, bool, bool *, bool *, bool *, double *);

#define STATE "fmi3%sFMUState"
#define FUNCTION(name) "fmi3" name

static SetValues *set_float64;
static GetValues *get_float64;
static DoStep *do_step;

static void log_message(void *environment, int status, const char *category, const char *message) {
    (void)environment;
    fprintf(stderr, "status %d, %s: %s\n", status, category, message);
}

static void set(const unsigned *references, size_t count, const double *values) {
    if (set_float64(wheel, references, count, values, count) > 1) fail("fmi3SetFloat64");
}

static void get(const unsigned *references, size_t count, double *values, size_t size) {
    if (get_float64(wheel, references, count, values, size) > 1) fail("fmi3GetFloat64");
}

static void advance(double time) {
    bool event = true, terminate = true, early = true;
    double reached = -1.0;
    if (do_step(wheel, time, STEP, false, &event, &terminate, &early, &reached) > 1) fail("fmi3DoStep");
    if (event || terminate || early || reached != time + STEP) fail("fmi3DoStep: what it tells");
}

static void instantiate(const char *identity, const char *resources) {
    set_float64 = (SetValues *)function("fmi3SetFloat64");
    get_float64 = (GetValues *)function("fmi3GetFloat64");
    do_step = (DoStep *)function("fmi3DoStep");
    Instantiate *make = (Instantiate *)function("fmi3InstantiateCoSimulation");
    wheel = make("wheel", identity, resources, false, false, false, false, NULL, 0, NULL, log_message, NULL);
    if (!wheel) fail("fmi3InstantiateCoSimulation");
    Initialize *enter = (Initialize *)function("fmi3EnterInitializationMode");
    if (enter(wheel, false, 0.0, 0.0, false, 0.0) != 0) fail("fmi3EnterInitializationMode");
}

#else

typedef void Logger(void *, const char *, int, const char *, const char *, ...);
typedef struct {
    Logger *log;
    void *(*allocate)(size_t, size_t);
    void (*release)(void *);
    void (*step_finished)(void *, int);
    void *environment;
} Callbacks;
typedef Component Instantiate(const char *, int, const char *, const char *, const Callbacks *, int, int);
typedef int Setup(Component, int, double, double, int, double);
typedef int SetReal(Component, const unsigned *, size_t, const double *);
typedef int GetReal(Component, const unsigned *, size_t, double *);
typedef int DoStep(Component, double, double, int);

#define STATE "fmi2%sFMUstate"
#define FUNCTION(name) "fmi2" name

static SetReal *set_real;
static GetReal *get_real;
static DoStep *do_step;

static void log_message(void *environment, const char *name, int status, const char *category, const char *format, ...) {
    va_list arguments;
    (void)environment;
    fprintf(stderr, "%s: status %d, %s: ", name, status, category);
    va_start(arguments, format);
    vfprintf(stderr, format, arguments);
    va_end(arguments);
    fputc('\n', stderr);
}

static void set(const unsigned *references, size_t count, const double *values) {
    if (set_real(wheel, references, count, values) > 1) fail("fmi2SetReal");
}

static void get(const unsigned *references, size_t count, double *values, size_t size) {
    if (size != count) fail("reading the arguments: FMI 2.0 has no arrays");
    if (get_real(wheel, references, count, values) > 1) fail("fmi2GetReal");
}

static void advance(double time) {
    if (do_step(wheel, time, STEP, 0) > 1) fail("fmi2DoStep");
}

static void instantiate(const char *identity, const char *resources) {
    static const Callbacks callbacks = { log_message, calloc, free, NULL, NULL };
    set_real = (SetReal *)function("fmi2SetReal");
    get_real = (GetReal *)function("fmi2GetReal");
    do_step = (DoStep *)function("fmi2DoStep");
    wheel = ((Instantiate *)function("fmi2Instantiate"))("wheel", 1, identity, resources, &callbacks, 0, 0);
    if (!wheel) fail("fmi2Instantiate");
    if (((Setup *)function("fmi2SetupExperiment"))(wheel, 0, 0.0, 0.0, 0, 0.0) != 0) fail("fmi2SetupExperiment");
    call("fmi2EnterInitializationMode");
}

#endif

/* The function of states of that name. */
static void *state_function(const char *name) {
    char whole[32];
    snprintf(whole, sizeof whole, STATE, name);
    return function(whole);
}

/* Moment and load of a step: the brake is applied within 0.3 s, pulled beyond adhesion for 0.05 s, so that the wheel slides,
 * released for 0.15 s, pulled as before and eased within the last 0.5 s; the load swings by 8 %. */
static void inputs(int step) {
    double applied = step < 300 ? step / 300.0 : step < 1500 ? 1.0 : (2000 - step) / 500.0;
    if (step >= 1000 && step < 1200) applied = step < 1050 ? 1.8 : 0.0;
    double phase = (step % 400) / 400.0;
    double values[2] = { -9000.0 * applied, 100000.0 * (1.0 + 1.6 * phase * (1.0 - phase) * (phase - 0.5)) };
    const unsigned references[2] = { DRIVE_MOMENT, DRIVE_LOAD };
    set(references, 2, values);
}

/* Outputs to print: value references, and the number of their values. */
static unsigned *references;
static size_t count, size;

/* Steps from..to; outputs go to `table`, one row a step. */
static void run(int from, int to, double *table) {
    for (int step = from; step < to; step++, table += size) {
        inputs(step);
        advance(step * STEP);
        get(references, count, table, size);
    }
}

static void print(const double *table) {
    for (int step = 0; step < STEPS; step += PRINTED) {
        printf("%d", step);
        for (size_t i = 0; i < size; i++) printf(" %.17g", table[step * size + i]);
        putchar('\n');
    }
}

int main(int arguments, char **argument) {
    count = arguments > 4 ? (size_t)arguments - 4 : 0;
    if (count == 0) fail("reading the arguments: host LIBRARY IDENTITY RESOURCES REFERENCE[:SIZE]...");
    references = calloc(count, sizeof(unsigned));
    if (!references) fail("allocation");
    for (size_t i = 0; i < count; i++) {
        char *end;
        references[i] = (unsigned)strtoul(argument[4 + i], &end, 10);
        size += *end == ':' ? (size_t)strtoul(end + 1, NULL, 10) : 1;
    }
    double *table = calloc(STEPS * size, sizeof(double)), *again = calloc(REPEATED * size, sizeof(double));
    if (!table || !again) fail("allocation");

    library = open_library(argument[1]);
    if (!library) fail("loading the library");
    instantiate(argument[2], argument[3]);
    inputs(0);
    call(FUNCTION("ExitInitializationMode"));

    clock_t start = clock();
    State saved = NULL;
    run(0, SAVED, table);
    if (((OnState *)state_function("Get"))(wheel, &saved) != 0) fail("saving a state");
    run(SAVED, SAVED + REPEATED, again);
    if (((SetState *)state_function("Set"))(wheel, saved) != 0) fail("restoring a state");
    if (((OnState *)state_function("Free"))(wheel, &saved) != 0 || saved) fail("freeing a state");
    run(SAVED, STEPS, table + SAVED * size);
    if (memcmp(again, table + SAVED * size, REPEATED * size * sizeof(double)) != 0) fail("rollback: repeating the steps bit for bit");
    fprintf(stderr, "%.3f s for %d steps\n", (double)(clock() - start) / CLOCKS_PER_SEC, STEPS + REPEATED);
    print(table);

    call(FUNCTION("Terminate"));
    ((Free *)function(FUNCTION("FreeInstance")))(wheel);
    if (close_library(library) != 0) fail("unloading the library");
    free(references);
    free(table);
    free(again);
    return 0;
}
