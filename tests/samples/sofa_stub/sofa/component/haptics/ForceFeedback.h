#pragma once
// A stand-in of SOFA for the test of samples/sofa: the virtual functions of its class ForceFeedback, and as much of its
// Data. Nothing of SOFA is in it.
using SReal = double;

namespace sofa {

template <class Value>
class Data {
public:
    // NOLINTNEXTLINE(google-explicit-constructor): as SOFA's
    Data(Value value) : value_(value) {}
    [[nodiscard]] const Value& getValue() const { return value_; }
    void                       setValue(const Value& value) { value_ = value; }

private:
    Value value_;
};

template <class Value>
Value initData(Data<Value>* /*of*/, Value value, const char* /*name*/, const char* /*help*/)
{
    return value;
}

namespace defaulttype {
template <class Real>
struct SolidTypes {
    struct Transform {};
    struct SpatialVector {};
};
} // namespace defaulttype

namespace component::haptics {
class ForceFeedback {
public:
    virtual ~ForceFeedback() = default;
    virtual void init() {}
    virtual void computeForce(SReal x, SReal y, SReal z, SReal u, SReal v, SReal w, SReal q, SReal& fx, SReal& fy,
                              SReal& fz)                                       = 0;
    virtual void computeWrench(const defaulttype::SolidTypes<SReal>::Transform&,
                               const defaulttype::SolidTypes<SReal>::SpatialVector&,
                               defaulttype::SolidTypes<SReal>::SpatialVector&) = 0;
};
} // namespace component::haptics
} // namespace sofa

#define SOFA_CLASS(own, base) using Base = base
