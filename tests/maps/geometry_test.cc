// Where lights and cameras stand for each texel, how pixels become values, and tables of numbers.
#include "lobefit/maps/stack/geometry.h"

#include <cmath>

#include "tests/support/folder_test.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lobefit/base/error.h"
#include "lobefit/maps/stack/layouts.h"
#include "lobefit/maps/stack/response.h"

namespace lobefit {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

Stack NearStack() {
  Stack stack;
  stack.width = 4, stack.height = 2;
  for (const Vec3& place : {Vec3{0, 0, 100}, Vec3{60, -30, 80}, Vec3{-200, 10, 5}})
    stack.lights.push_back({Normalized(place), {1, 1, 1}, place});
  SetNear({true, 0, 0}, 40, "stack", &stack);
  return stack;
}

// Pixels of 10 mm: the first row is above the middle, the first column left of it.
TEST(Geometry, TexelsStandInThePlane) {
  const Stack stack = NearStack();
  const Vec3 first = PointOf(stack, 0), last = PointOf(stack, 7);
  EXPECT_EQ(Norm(first - Vec3{-15, 5, 0}), 0);
  EXPECT_EQ(Norm(last - Vec3{15, -5, 0}), 0);
  Vec3 sum = {0, 0, 0};
  for (std::size_t t = 0; t < 8; ++t) sum = sum + PointOf(stack, t);
  EXPECT_NEAR(Norm(sum), 0, 1e-12);
}

TEST(Geometry, DirectionsLeadFromTheTexelToTheLight) {
  Stack stack = NearStack();
  stack.cameras = {{0, 0, 300}};
  for (std::size_t light = 0; light < 3; ++light) {
    for (std::size_t texel = 0; texel < 8; ++texel) {
      const Vec3 w = DirectionAt(stack, light, texel), way = stack.lights[light].place - PointOf(stack, texel);
      EXPECT_NEAR(Norm(w), 1, 1e-15);
      EXPECT_NEAR(Norm(Cross(w, way)), 0, 1e-12);
      EXPECT_GT(Dot(w, way), 0);
      const Vec3 view = ViewAt(stack, light, texel);
      EXPECT_NEAR(Norm(PointOf(stack, texel) + (300 / view.z) * view - stack.cameras[0]), 0, 1e-10);
    }
  }
  LightPaths paths;
  PathsAt(stack, {2, 0}, 5, &paths);
  ASSERT_TRUE(paths.wi.size() == 2 && paths.wo.size() == 2);
  EXPECT_EQ(Norm(paths.wi[0] - DirectionAt(stack, 2, 5)), 0);
  EXPECT_EQ(Norm(paths.wo[1] - ViewAt(stack, 0, 5)), 0);
  // One camera a photograph; then none, seen along the normal.
  stack.cameras = {{0, 0, 300}, {100, 0, 300}, {0, 100, 300}};
  EXPECT_GT(ViewAt(stack, 1, 0).x, ViewAt(stack, 0, 0).x);
  stack.cameras.clear();
  PathsAt(stack, {1}, 5, &paths);
  EXPECT_TRUE(paths.wo.empty());
  stack.near.reset();
  EXPECT_EQ(Norm(DirectionAt(stack, 1, 0) - stack.lights[1].direction), 0);
  EXPECT_EQ(IrradianceAt(stack, 1, 0), 1);
}

// A lamp twice as far gives a quarter; a flat one falls with the cosine to its axis, which points to the middle.
TEST(Geometry, IrradianceFallsWithDistanceAndAxis) {
  Stack stack = NearStack();
  const double reference = (100 + std::sqrt(60. * 60 + 30 * 30 + 80 * 80) + std::sqrt(200. * 200 + 10 * 10 + 25)) / 3;
  EXPECT_NEAR(stack.near->reference_mm, reference, 1e-12);
  for (std::size_t texel = 0; texel < 8; ++texel) {
    const Vec3 way = stack.lights[1].place - PointOf(stack, texel);
    const double bulb = reference * reference / Dot(way, way);
    EXPECT_NEAR(IrradianceAt(stack, 1, texel), bulb, 1e-12);
    stack.near->exponent = 1;
    const double cosine = Dot(Normalized(way), Normalized(stack.lights[1].place));
    EXPECT_NEAR(IrradianceAt(stack, 1, texel), bulb * cosine, 1e-12);
    stack.near->inverse_square = false;
    EXPECT_NEAR(IrradianceAt(stack, 1, texel), cosine, 1e-12);
    stack.near->inverse_square = true, stack.near->exponent = 0;
  }
}

TEST(Response, CurvesAreInversesAndKeepWhite) {
  for (const char* word : {"linear", "srgb", "gamma:2.2", "gamma:0.1", "gamma:10"}) {
    Response response;
    ReadEncoding(word, "here", &response);
    EXPECT_EQ(EncodingWord(response), word);
    EXPECT_EQ(Linear(response, 0), 0);
    EXPECT_NEAR(Linear(response, 1), 1, 1e-15);
    for (double v = 0.001; v < 1; v += 0.037) {
      EXPECT_NEAR(Linear(response, Stored(response, v)), v, 1e-7 * v) << word;
      EXPECT_GT(Linear(response, v + 0.001), Linear(response, v)) << word;
    }
    response.black = 0.1;
    EXPECT_NEAR(Linear(response, 0.1 + Stored(response, 0.4)), 0.4, 1e-7) << word;
    EXPECT_LE(Linear(response, 0.05), 0) << "below black, " << word;
  }
  for (const char* word : {"", "sRGB", "gamma", "gamma:", "gamma:0.09", "gamma:11", "gamma:nan", "gamma:2,2"}) {
    Response response;
    EXPECT_THAT([&] { ReadEncoding(word, "stack.toml:3", &response); },
                ThrowsMessage<InputError>(testing::AllOf(HasSubstr("stack.toml:3: encoding '" + std::string(word)),
                                                         HasSubstr("allowed: linear, srgb, gamma:G"))));
  }
}

class Tables : public FolderTest {
 protected:
  std::vector<std::vector<double>> Table(const std::string& text, std::size_t columns) const {
    Write("t.txt", text);
    return ReadTable(folder_ / "t.txt", columns);
  }
};

TEST_F(Tables, OfRowsAndOfColumns) {
  using Rows = std::vector<std::vector<double>>;
  const Rows expected = {{1, 2, 3}, {4, 5, 6.5}};
  EXPECT_EQ(Table("# x y z\n1 2\t3\r\n\n  4 5 6.5", 3), expected);
  EXPECT_EQ(Table("1 4\n2 5\n3 6.5\n", 3), expected) << "three rows of two";
  const Rows square = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
  EXPECT_EQ(Table("1 2 3\n4 5 6\n7 8 9\n", 3), square) << "not turned";
  EXPECT_TRUE(Table("# nothing\n", 3).empty());
}

TEST_F(Tables, WhatIsWrongIsNamedWithItsLine) {
  const auto refused = [&](const char* text, const char* words) {
    EXPECT_THAT([&] { Table(text, 3); }, ThrowsMessage<InputError>(HasSubstr(words)));
  };
  refused("1 2 3\n\n1 2 x\n", "t.txt:3: 'x' is no finite number; 3 numbers a line are expected");
  refused("1 2 inf\n", ":1: 'inf' is no finite number");
  refused("1 2 3\n1 2\n", "t.txt:2: 2 numbers, but 3 in the lines before");
  refused("1 2\n3 4\n", "2 numbers a line; 3 are expected");
  EXPECT_THAT([] { LightDirection(0, 0, 1e-5, "a.lp:2"); }, ThrowsMessage<InputError>(HasSubstr("a.lp:2: (0, 0, ")));
  EXPECT_THROW(LightDirection(HUGE_VAL, 0, 1, ""), InputError);
}

TEST_F(Tables, PositionsBehindThePictureAreRefused) {
  Stack stack = NearStack();
  stack.lights[1].place.z = 0;
  EXPECT_THAT([&] { SetNear({}, 40, "a.dome", &stack); },
              ThrowsMessage<InputError>(HasSubstr("a.dome: light 2 at z = 0 mm is not in front of the picture")));
  EXPECT_THAT(
      [&] {
        SetCameras({{0, 0, 1}, {0, 0, -3}}, 40, "a.toml", &stack);
      },
      ThrowsMessage<InputError>(HasSubstr("a.toml: camera 2 at z = -3 mm")));
}

}  // namespace
}  // namespace lobefit
