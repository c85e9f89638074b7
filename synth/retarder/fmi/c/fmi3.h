/* Types of the Functional Mock-up Interface 3.0 (FMI 3.0.1, section 2.2.3), as far as these units take them. */
#ifndef UNIT_FMI3_H
#define UNIT_FMI3_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef void *fmi3Instance;
typedef void *fmi3InstanceEnvironment;
typedef void *fmi3FMUState;
typedef uint32_t fmi3ValueReference;
typedef float fmi3Float32;
typedef double fmi3Float64;
typedef int8_t fmi3Int8;
typedef uint8_t fmi3UInt8;
typedef int16_t fmi3Int16;
typedef uint16_t fmi3UInt16;
typedef int32_t fmi3Int32;
typedef uint32_t fmi3UInt32;
typedef int64_t fmi3Int64;
typedef uint64_t fmi3UInt64;
typedef bool fmi3Boolean;
typedef const char *fmi3String;
typedef uint8_t fmi3Byte;
typedef const fmi3Byte *fmi3Binary;
typedef bool fmi3Clock;

typedef enum { fmi3OK, fmi3Warning, fmi3Discard, fmi3Error, fmi3Fatal } fmi3Status;
typedef enum { fmi3Independent, fmi3Constant, fmi3Fixed, fmi3Tunable, fmi3Discrete, fmi3Dependent } fmi3DependencyKind;
typedef enum { fmi3IntervalNotYetKnown, fmi3IntervalUnchanged, fmi3IntervalChanged } fmi3IntervalQualifier;

typedef void (*fmi3LogMessageCallback)(fmi3InstanceEnvironment, fmi3Status, fmi3String category, fmi3String message);
typedef void (*fmi3AnyCallback)(void); /* the callbacks that these units never call */

/* The name of a function: where units are linked statically, with the prefix that the importing tool gives. */
#if defined FMI2_FUNCTION_PREFIX && !defined FMI3_FUNCTION_PREFIX
#define FMI3_FUNCTION_PREFIX FMI2_FUNCTION_PREFIX /* a unit of FMI 2.0 stands on these functions */
#endif
#ifdef FMI3_FUNCTION_PREFIX
#define FMI3_JOINED(prefix, name) prefix##name
#define FMI3_PREFIXED(prefix, name) FMI3_JOINED(prefix, name)
#define FMI3(name) FMI3_PREFIXED(FMI3_FUNCTION_PREFIX, fmi3##name)
#define FMI3_EXPORT
#else
#define FMI3(name) fmi3##name
#if defined _WIN32
#define FMI3_EXPORT __declspec(dllexport)
#elif defined __GNUC__
#define FMI3_EXPORT __attribute__((visibility("default")))
#else
#define FMI3_EXPORT
#endif
#endif

#endif
