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

TEST_F(TouchViewTest, ADentBeyondTheColoursIsSaid)
{
    PlateSolver   host("host");
    const Contact contact = touchAt(object_, sample_.place, sample_.from, PatchSettings{}.window / 4);
    const Patch   patch   = deform(object_, contact, PatchSettings{}, host);
    TouchLook     look;
    view_.show(&patch, 1, look);
    EXPECT_FALSE(view_.scene().colours.goesOn) << "a touch has all its own colours";
    look.deepest = view_.scene().colours.range.high;
    view_.show(&patch, 0.9, look);
    EXPECT_FALSE(view_.scene().colours.goesOn);
    view_.show(&patch, 1.1, look);
    EXPECT_TRUE(view_.scene().colours.goesOn);
}

} // namespace
} // namespace palp
