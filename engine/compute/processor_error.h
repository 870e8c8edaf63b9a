#pragma once
#include "engine/core/contract.h"

namespace palp::compute {

/// Says that no processor has what is needed. The message has one line per processor with why it was refused; programs
/// print it and exit with 4.
class ProcessorError : public Error {
public:
    using Error::Error;
};

/// Says that no processor fits the word that names one, or that several do, while others could be used: bad usage. The
/// message has one line per processor; programs print it and exit with 2.
class UnknownProcessor : public Error {
public:
    using Error::Error;
};

/// Says that the processor went away, hangs or has no memory left while it was in use. Unless it is
/// ProcessorOutOfMemory, what lived on it is gone, and only a new Context may work.
class ProcessorLost : public Error {
public:
    using Error::Error;
};

/// Says that a buffer is larger than the processor has memory for. The processor itself can go on with smaller ones.
class ProcessorOutOfMemory : public ProcessorLost {
public:
    using ProcessorLost::ProcessorLost;
};

} // namespace palp::compute
