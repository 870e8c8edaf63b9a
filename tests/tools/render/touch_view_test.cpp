#include "engine/tools/render/touch_view.h"

#include <gtest/gtest.h>

#include "engine/cloud/samples.h"
#include "engine/pipeline/deform.h"

namespace palp {
namespace {

class TouchViewTest : public ::testing::Test {
protected:
    ViewScene& shownAs(ViewPaint paint)
    {
        TouchLook look;
        look.paint = paint;
        view_.show(nullptr, 0, look);
        return view_.scene();
    }

    const Sample& sample_ = sampleNamed("sheet");
    SoftObject    object_{makeSample(sample_, 2000, 1), sample_.material};
    TouchView     view_{object_, PatchSettings{}};
};

TEST_F(TouchViewTest, StiffnessIsSeenInAnEvenLightAndDentsByTheirRelief)
{
    EXPECT_GE(shownAs(ViewPaint::stiffness).evenLight, 0.5) << "as bright on slopes as in the legend";
    EXPECT_EQ(shownAs(ViewPaint::deflection).evenLight, 0);
    EXPECT_EQ(shownAs(ViewPaint::plain).evenLight, 0);
}

} // namespace
} // namespace palp
