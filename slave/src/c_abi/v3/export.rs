//! Symbols of the functions.

/// Exports the C functions of FMI 3.0 for a type that implements [`ArrayAccess`](crate::ArrayAccess).
///
/// A library calls it once, in a module of its own; `fmpy_tests/test_fmi3.py` compares every function with the header
/// of the standard.
#[macro_export]
macro_rules! export_fmi3 {
    (@with $Slave:ty: $($name:ident($($argument:ident: $kind:ty),*) -> $result:ty;)*) => {$(
        #[doc = concat!("`", stringify!($name), "` of the standard.")]
        #[allow(clippy::missing_safety_doc, clippy::too_many_arguments)]
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $name($($argument: $kind),*) -> $result {
            // SAFETY: that of this function.
            unsafe { $crate::c_abi::v3::$name::<$Slave>($($argument),*) }
        }
    )*};
    (@refused $Slave:ty, $why:literal: $($name:ident($instance:ident: $Instance:ty $(, $argument:ident: $kind:ty)*);)*) => {$(
        #[doc = concat!("`", stringify!($name), "`, refused: this FMU ", $why, ".")]
        #[allow(clippy::missing_safety_doc, clippy::too_many_arguments)]
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $name($instance: $Instance $(, _: $kind)*) -> fmi3Status {
            // SAFETY: that of this function.
            unsafe { $crate::c_abi::v3::refused::<$Slave>($instance, stringify!($name), $why) }
        }
    )*};
    (@none $($name:ident(
        $($argument:ident: $kind:ty),*; $environment:ident: $Environment:ty, $log:ident: $Log:ty $(, $more:ident: $other:ty)*
    );)*) => {$(
        #[doc = concat!("`", stringify!($name), "`, refused: co-simulation is the only kind of this FMU.")]
        #[allow(clippy::too_many_arguments)]
        #[unsafe(no_mangle)]
        pub extern "C" fn $name($(_: $kind,)* $environment: $Environment, $log: $Log $(, _: $other)*) -> fmi3Instance {
            $crate::c_abi::v3::no_instance(stringify!($name), $environment, $log)
        }
    )*};
    ($Slave:ty) => {
        use $crate::c_abi::v3::types::*;
        use std::ffi::c_char;

        /// Version of the standard.
        #[unsafe(no_mangle)]
        pub extern "C" fn fmi3GetVersion() -> *const c_char {
            $crate::c_abi::v3::fmi3GetVersion()
        }

        /// Frees an instance.
        #[allow(clippy::missing_safety_doc)]
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn fmi3FreeInstance(instance: fmi3Instance) {
            // SAFETY: that of this function.
            unsafe { $crate::c_abi::v3::fmi3FreeInstance::<$Slave>(instance) }
        }

        $crate::export_fmi3! { @none
            fmi3InstantiateModelExchange(
                instanceName: fmi3String, instantiationToken: fmi3String, resourcePath: fmi3String,
                visible: fmi3Boolean, loggingOn: fmi3Boolean; instanceEnvironment: fmi3InstanceEnvironment,
                logMessage: fmi3LogMessageCallback
            );
            fmi3InstantiateScheduledExecution(
                instanceName: fmi3String, instantiationToken: fmi3String, resourcePath: fmi3String,
                visible: fmi3Boolean, loggingOn: fmi3Boolean; instanceEnvironment: fmi3InstanceEnvironment,
                logMessage: fmi3LogMessageCallback, clockUpdate: fmi3ClockUpdateCallback,
                lockPreemption: fmi3LockPreemptionCallback, unlockPreemption: fmi3UnlockPreemptionCallback
            );
        }
        $crate::export_fmi3! { @with $Slave:
            fmi3InstantiateCoSimulation(
                instanceName: fmi3String, instantiationToken: fmi3String, resourcePath: fmi3String,
                visible: fmi3Boolean, loggingOn: fmi3Boolean, eventModeUsed: fmi3Boolean,
                earlyReturnAllowed: fmi3Boolean, requiredIntermediateVariables: *const fmi3ValueReference,
                nRequiredIntermediateVariables: usize, instanceEnvironment: fmi3InstanceEnvironment,
                logMessage: fmi3LogMessageCallback, intermediateUpdate: fmi3IntermediateUpdateCallback
            ) -> fmi3Instance;
            fmi3SetDebugLogging(
                instance: fmi3Instance, loggingOn: fmi3Boolean, nCategories: usize, categories: *const fmi3String
            ) -> fmi3Status;
            fmi3EnterInitializationMode(
                instance: fmi3Instance, toleranceDefined: fmi3Boolean, tolerance: fmi3Float64,
                startTime: fmi3Float64, stopTimeDefined: fmi3Boolean, stopTime: fmi3Float64
            ) -> fmi3Status;
            fmi3ExitInitializationMode(instance: fmi3Instance) -> fmi3Status;
            fmi3Terminate(instance: fmi3Instance) -> fmi3Status;
            fmi3Reset(instance: fmi3Instance) -> fmi3Status;
            fmi3GetFloat64(
                instance: fmi3Instance, valueReferences: *const fmi3ValueReference, nValueReferences: usize,
                values: *mut fmi3Float64, nValues: usize
            ) -> fmi3Status;
            fmi3GetInt32(
                instance: fmi3Instance, valueReferences: *const fmi3ValueReference, nValueReferences: usize,
                values: *mut fmi3Int32, nValues: usize
            ) -> fmi3Status;
            fmi3GetInt64(
                instance: fmi3Instance, valueReferences: *const fmi3ValueReference, nValueReferences: usize,
                values: *mut fmi3Int64, nValues: usize
            ) -> fmi3Status;
            fmi3GetBoolean(
                instance: fmi3Instance, valueReferences: *const fmi3ValueReference, nValueReferences: usize,
                values: *mut fmi3Boolean, nValues: usize
            ) -> fmi3Status;
            fmi3GetString(
                instance: fmi3Instance, valueReferences: *const fmi3ValueReference, nValueReferences: usize,
                values: *mut fmi3String, nValues: usize
            ) -> fmi3Status;
            fmi3SetFloat64(
                instance: fmi3Instance, valueReferences: *const fmi3ValueReference, nValueReferences: usize,
                values: *const fmi3Float64, nValues: usize
            ) -> fmi3Status;
            fmi3SetInt32(
                instance: fmi3Instance, valueReferences: *const fmi3ValueReference, nValueReferences: usize,
                values: *const fmi3Int32, nValues: usize
            ) -> fmi3Status;
            fmi3SetInt64(
                instance: fmi3Instance, valueReferences: *const fmi3ValueReference, nValueReferences: usize,
                values: *const fmi3Int64, nValues: usize
            ) -> fmi3Status;
            fmi3SetBoolean(
                instance: fmi3Instance, valueReferences: *const fmi3ValueReference, nValueReferences: usize,
                values: *const fmi3Boolean, nValues: usize
            ) -> fmi3Status;
            fmi3SetString(
                instance: fmi3Instance, valueReferences: *const fmi3ValueReference, nValueReferences: usize,
                values: *const fmi3String, nValues: usize
            ) -> fmi3Status;
            fmi3GetFMUState(instance: fmi3Instance, FMUState: *mut fmi3FMUState) -> fmi3Status;
            fmi3SetFMUState(instance: fmi3Instance, FMUState: fmi3FMUState) -> fmi3Status;
            fmi3FreeFMUState(instance: fmi3Instance, FMUState: *mut fmi3FMUState) -> fmi3Status;
            fmi3SerializedFMUStateSize(instance: fmi3Instance, FMUState: fmi3FMUState, size: *mut usize) -> fmi3Status;
            fmi3SerializeFMUState(
                instance: fmi3Instance, FMUState: fmi3FMUState, serializedState: *mut fmi3Byte, size: usize
            ) -> fmi3Status;
            fmi3DeserializeFMUState(
                instance: fmi3Instance, serializedState: *const fmi3Byte, size: usize, FMUState: *mut fmi3FMUState
            ) -> fmi3Status;
            fmi3GetDirectionalDerivative(
                instance: fmi3Instance, unknowns: *const fmi3ValueReference, nUnknowns: usize,
                knowns: *const fmi3ValueReference, nKnowns: usize, seed: *const fmi3Float64, nSeed: usize,
                sensitivity: *mut fmi3Float64, nSensitivity: usize
            ) -> fmi3Status;
            fmi3GetAdjointDerivative(
                instance: fmi3Instance, unknowns: *const fmi3ValueReference, nUnknowns: usize,
                knowns: *const fmi3ValueReference, nKnowns: usize, seed: *const fmi3Float64, nSeed: usize,
                sensitivity: *mut fmi3Float64, nSensitivity: usize
            ) -> fmi3Status;
            fmi3GetOutputDerivatives(
                instance: fmi3Instance, valueReferences: *const fmi3ValueReference, nValueReferences: usize,
                orders: *const fmi3Int32, values: *mut fmi3Float64, nValues: usize
            ) -> fmi3Status;
            fmi3DoStep(
                instance: fmi3Instance, currentCommunicationPoint: fmi3Float64, communicationStepSize: fmi3Float64,
                noSetFMUStatePriorToCurrentPoint: fmi3Boolean, eventHandlingNeeded: *mut fmi3Boolean,
                terminateSimulation: *mut fmi3Boolean, earlyReturn: *mut fmi3Boolean,
                lastSuccessfulTime: *mut fmi3Float64
            ) -> fmi3Status;
        }
        $crate::export_fmi3! { @refused $Slave, "has no variables of this type; what its variables are stands in the model description":
            fmi3GetFloat32(
                instance: fmi3Instance, valueReferences: *const fmi3ValueReference, nValueReferences: usize,
                values: *mut fmi3Float32, nValues: usize
            );
            fmi3GetInt8(
                instance: fmi3Instance, valueReferences: *const fmi3ValueReference, nValueReferences: usize,
                values: *mut fmi3Int8, nValues: usize
            );
            fmi3GetUInt8(
                instance: fmi3Instance, valueReferences: *const fmi3ValueReference, nValueReferences: usize,
                values: *mut fmi3UInt8, nValues: usize
            );
            fmi3GetInt16(
                instance: fmi3Instance, valueReferences: *const fmi3ValueReference, nValueReferences: usize,
                values: *mut fmi3Int16, nValues: usize
            );
            fmi3GetUInt16(
                instance: fmi3Instance, valueReferences: *const fmi3ValueReference, nValueReferences: usize,
                values: *mut fmi3UInt16, nValues: usize
            );
            fmi3GetUInt32(
                instance: fmi3Instance, valueReferences: *const fmi3ValueReference, nValueReferences: usize,
                values: *mut fmi3UInt32, nValues: usize
            );
            fmi3GetUInt64(
                instance: fmi3Instance, valueReferences: *const fmi3ValueReference, nValueReferences: usize,
                values: *mut fmi3UInt64, nValues: usize
            );
            fmi3GetBinary(
                instance: fmi3Instance, valueReferences: *const fmi3ValueReference, nValueReferences: usize,
                valueSizes: *mut usize, values: *mut fmi3Binary, nValues: usize
            );
            fmi3SetFloat32(
                instance: fmi3Instance, valueReferences: *const fmi3ValueReference, nValueReferences: usize,
                values: *const fmi3Float32, nValues: usize
            );
            fmi3SetInt8(
                instance: fmi3Instance, valueReferences: *const fmi3ValueReference, nValueReferences: usize,
                values: *const fmi3Int8, nValues: usize
            );
            fmi3SetUInt8(
                instance: fmi3Instance, valueReferences: *const fmi3ValueReference, nValueReferences: usize,
                values: *const fmi3UInt8, nValues: usize
            );
            fmi3SetInt16(
                instance: fmi3Instance, valueReferences: *const fmi3ValueReference, nValueReferences: usize,
                values: *const fmi3Int16, nValues: usize
            );
            fmi3SetUInt16(
                instance: fmi3Instance, valueReferences: *const fmi3ValueReference, nValueReferences: usize,
                values: *const fmi3UInt16, nValues: usize
            );
            fmi3SetUInt32(
                instance: fmi3Instance, valueReferences: *const fmi3ValueReference, nValueReferences: usize,
                values: *const fmi3UInt32, nValues: usize
            );
            fmi3SetUInt64(
                instance: fmi3Instance, valueReferences: *const fmi3ValueReference, nValueReferences: usize,
                values: *const fmi3UInt64, nValues: usize
            );
            fmi3SetBinary(
                instance: fmi3Instance, valueReferences: *const fmi3ValueReference, nValueReferences: usize,
                valueSizes: *const usize, values: *const fmi3Binary, nValues: usize
            );
        }
        $crate::export_fmi3! { @refused $Slave, "has no clocks":
            fmi3GetClock(
                instance: fmi3Instance, valueReferences: *const fmi3ValueReference, nValueReferences: usize,
                values: *mut fmi3Clock
            );
            fmi3SetClock(
                instance: fmi3Instance, valueReferences: *const fmi3ValueReference, nValueReferences: usize,
                values: *const fmi3Clock
            );
            fmi3GetIntervalDecimal(
                instance: fmi3Instance, valueReferences: *const fmi3ValueReference, nValueReferences: usize,
                intervals: *mut fmi3Float64, qualifiers: *mut fmi3IntervalQualifier
            );
            fmi3GetIntervalFraction(
                instance: fmi3Instance, valueReferences: *const fmi3ValueReference, nValueReferences: usize,
                counters: *mut fmi3UInt64, resolutions: *mut fmi3UInt64, qualifiers: *mut fmi3IntervalQualifier
            );
            fmi3GetShiftDecimal(
                instance: fmi3Instance, valueReferences: *const fmi3ValueReference, nValueReferences: usize,
                shifts: *mut fmi3Float64
            );
            fmi3GetShiftFraction(
                instance: fmi3Instance, valueReferences: *const fmi3ValueReference, nValueReferences: usize,
                counters: *mut fmi3UInt64, resolutions: *mut fmi3UInt64
            );
            fmi3SetIntervalDecimal(
                instance: fmi3Instance, valueReferences: *const fmi3ValueReference, nValueReferences: usize,
                intervals: *const fmi3Float64
            );
            fmi3SetIntervalFraction(
                instance: fmi3Instance, valueReferences: *const fmi3ValueReference, nValueReferences: usize,
                counters: *const fmi3UInt64, resolutions: *const fmi3UInt64
            );
            fmi3SetShiftDecimal(
                instance: fmi3Instance, valueReferences: *const fmi3ValueReference, nValueReferences: usize,
                shifts: *const fmi3Float64
            );
            fmi3SetShiftFraction(
                instance: fmi3Instance, valueReferences: *const fmi3ValueReference, nValueReferences: usize,
                counters: *const fmi3UInt64, resolutions: *const fmi3UInt64
            );
            fmi3ActivateModelPartition(
                instance: fmi3Instance, clockReference: fmi3ValueReference, activationTime: fmi3Float64
            );
        }
        $crate::export_fmi3! { @refused $Slave, "tells no dependencies of elements (providesPerElementDependencies = false)":
            fmi3GetNumberOfVariableDependencies(
                instance: fmi3Instance, valueReference: fmi3ValueReference, nDependencies: *mut usize
            );
            fmi3GetVariableDependencies(
                instance: fmi3Instance, dependent: fmi3ValueReference, elementIndicesOfDependent: *mut usize,
                independents: *mut fmi3ValueReference, elementIndicesOfIndependents: *mut usize,
                dependencyKinds: *mut fmi3DependencyKind, nDependencies: usize
            );
        }
        $crate::export_fmi3! { @refused $Slave, "has no Event Mode (hasEventMode = false)":
            fmi3EnterEventMode(instance: fmi3Instance);
            fmi3EvaluateDiscreteStates(instance: fmi3Instance);
            fmi3UpdateDiscreteStates(
                instance: fmi3Instance, discreteStatesNeedUpdate: *mut fmi3Boolean,
                terminateSimulation: *mut fmi3Boolean, nominalsOfContinuousStatesChanged: *mut fmi3Boolean,
                valuesOfContinuousStatesChanged: *mut fmi3Boolean, nextEventTimeDefined: *mut fmi3Boolean,
                nextEventTime: *mut fmi3Float64
            );
            fmi3EnterStepMode(instance: fmi3Instance);
        }
        $crate::export_fmi3! { @refused $Slave, "has no structural parameters":
            fmi3EnterConfigurationMode(instance: fmi3Instance);
            fmi3ExitConfigurationMode(instance: fmi3Instance);
        }
        $crate::export_fmi3! { @refused $Slave, "is one of co-simulation, not of Model Exchange":
            fmi3EnterContinuousTimeMode(instance: fmi3Instance);
            fmi3CompletedIntegratorStep(
                instance: fmi3Instance, noSetFMUStatePriorToCurrentPoint: fmi3Boolean,
                enterEventMode: *mut fmi3Boolean, terminateSimulation: *mut fmi3Boolean
            );
            fmi3SetTime(instance: fmi3Instance, time: fmi3Float64);
            fmi3SetContinuousStates(
                instance: fmi3Instance, continuousStates: *const fmi3Float64, nContinuousStates: usize
            );
            fmi3GetContinuousStateDerivatives(
                instance: fmi3Instance, derivatives: *mut fmi3Float64, nContinuousStates: usize
            );
            fmi3GetEventIndicators(
                instance: fmi3Instance, eventIndicators: *mut fmi3Float64, nEventIndicators: usize
            );
            fmi3GetContinuousStates(
                instance: fmi3Instance, continuousStates: *mut fmi3Float64, nContinuousStates: usize
            );
            fmi3GetNominalsOfContinuousStates(
                instance: fmi3Instance, nominals: *mut fmi3Float64, nContinuousStates: usize
            );
            fmi3GetNumberOfEventIndicators(instance: fmi3Instance, nEventIndicators: *mut usize);
            fmi3GetNumberOfContinuousStates(instance: fmi3Instance, nContinuousStates: *mut usize);
        }
    };
}
