#pragma once
#include "engine/core/contract.h"

namespace palp::compute {

/// There is no device with what is needed. The message has one line per device and says why it was refused; programs
/// print it and exit with 4.
class ProcessorError : public Error {
public:
    using Error::Error;
};

/// Nothing fits the word that names a device, or too much does, and other devices could be used: bad usage. The
/// message has one line per device; programs print it and exit with 2.
class UnknownProcessor : public Error {
public:
    using Error::Error;
};

/// The device went away, hangs or has no memory left while it was in use. What lived on it is gone; a new Context may
/// work, a smaller problem as well.
class ProcessorLost : public Error {
public:
    using Error::Error;
};

} // namespace palp::compute
