// Texels parted by what they are made of: k-means against all partitions of a few, and what is not known.
#include "lobefit/maps/clusters.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace lobefit {
namespace {

Features Point(double x, double y) {
  Features features;
  features.fill(std::nan(""));
  features[0] = x, features[1] = y;
  return features;
}

// Sum over texels of the mean squared difference to the nearest centre, in units of the clusters.
double CostOf(const Clusters& clusters, const std::vector<Features>& texels) {
  double sum = 0;
  for (const Features& f : texels) {
    double least = HUGE_VAL;
    for (const Features& c : clusters.centers) {
      double square = 0;
      int known = 0;
      for (std::size_t k = 0; k < kFeatures; ++k) {
        const double d = (f[k] - c[k]) / clusters.unit[k];
        if (!std::isnan(d)) square += d * d, ++known;
      }
      least = std::min(least, known > 0 ? square / known : 0);
    }
    sum += least;
  }
  return sum;
}

// Against the least cost of any way to part nine texels into two: starts may all miss it, but not by much.
TEST(Clusters, OfFewTexelsAreTheBestOrNearly) {
  std::mt19937 engine(3);
  std::normal_distribution<double> normal;
  int hits = 0;
  for (int trial = 0; trial < 10; ++trial) {
    std::vector<Features> texels;
    for (int i = 0; i < 9; ++i) texels.push_back(Point(normal(engine), 3 * normal(engine)));
    const Clusters found = FindClusters(texels, 2);
    double least = HUGE_VAL;
    for (unsigned parting = 1; parting < 256; ++parting) {
      Clusters by_hand = {{Point(0, 0), Point(0, 0)}, found.unit};
      double counts[2] = {0, 0};
      for (unsigned i = 0; i < 9; ++i) {
        const unsigned side = parting >> i & 1U;
        for (std::size_t k = 0; k < 2; ++k) by_hand.centers[side][k] += texels[i][k];
        ++counts[side];
      }
      for (std::size_t side = 0; side < 2; ++side) {
        for (std::size_t k = 0; k < 2; ++k) by_hand.centers[side][k] /= counts[side];
      }
      least = std::min(least, CostOf(by_hand, texels));
    }
    EXPECT_LE(CostOf(found, texels), 1.05 * least);
    hits += CostOf(found, texels) < least * (1 + 1e-9) ? 1 : 0;
  }
  EXPECT_GE(hits, 8);
}

TEST(Clusters, AreTheHeapsTheLargestFirst) {
  std::mt19937 engine(4);
  std::normal_distribution<double> normal(0, 0.02);
  const double places[3][2] = {{0, 0}, {1, 2}, {-3, 1}};
  const int sizes[3] = {30, 200, 90};
  std::vector<Features> texels;
  for (int heap = 0; heap < 3; ++heap) {
    for (int i = 0; i < sizes[heap]; ++i)
      texels.push_back(Point(places[heap][0] + normal(engine), places[heap][1] + normal(engine)));
  }
  const Clusters clusters = FindClusters(texels, 3);
  ASSERT_EQ(clusters.centers.size(), 3U);
  for (std::size_t c = 0; c < 3; ++c) {
    const int heap = c == 0 ? 1 : c == 1 ? 2 : 0;
    EXPECT_NEAR(clusters.centers[c][0], places[heap][0], 0.02);
    EXPECT_NEAR(clusters.centers[c][1], places[heap][1], 0.02);
    EXPECT_TRUE(std::isnan(clusters.centers[c][kMostChannels])) << "nothing is known of f0";
    EXPECT_EQ(clusters.Nearest(Point(places[heap][0], std::nan(""))), c) << "by the number that is known";
  }
  EXPECT_EQ(clusters.Nearest(Point(std::nan(""), std::nan(""))), 0U);
}

TEST(Clusters, AreNoMoreThanThereAreTexels) {
  EXPECT_TRUE(FindClusters({}, 4).centers.empty());
  const std::vector<Features> same(50, Point(0.3, -1));
  ASSERT_EQ(FindClusters(same, 4).centers.size(), 1U);
  EXPECT_NEAR(FindClusters(same, 4).centers[0][1], -1, 1e-12);
  std::vector<Features> two = same;
  two.resize(60, Point(0.9, -1));
  EXPECT_EQ(FindClusters(two, 4).centers.size(), 2U);
  EXPECT_EQ(FindClusters(std::vector<Features>(9, Point(std::nan(""), std::nan(""))), 3).centers.size(), 1U);
}

// Interquartile ranges, but logarithms that differ by less than a twentieth are no difference of material.
TEST(Clusters, UnitsAreInterquartileRanges) {
  std::vector<Features> texels;
  for (int i = 0; i < 101; ++i) texels.push_back(Point(i, 1e-5 * i));
  const Clusters clusters = FindClusters(texels, 2);
  EXPECT_DOUBLE_EQ(clusters.unit[0], 50);
  EXPECT_DOUBLE_EQ(clusters.unit[1], 0.05);
}

TEST(Clusters, FeaturesAreLogarithms) {
  TexelFit fit;
  fit.diffuse[0] = 0.5, fit.diffuse[1] = 0.25, fit.diffuse[2] = 0;
  fit.f0[0] = 0.1, fit.f0[1] = 0.2, fit.f0[2] = 0.3;
  fit.alpha_x = 0.4, fit.alpha_y = 0.1;
  const Features features = FeaturesOf(fit, 3);
  EXPECT_DOUBLE_EQ(features[0], std::log(0.5));
  EXPECT_DOUBLE_EQ(features[1], std::log(0.25));
  EXPECT_TRUE(std::isfinite(features[2])) << "black is as dark as the darkest";
  EXPECT_NEAR(features[kMostChannels], std::log(0.2), 1e-15);
  EXPECT_NEAR(features[kMostChannels + 1], std::log(0.2), 1e-15);
  for (const double f : FeaturesOf(TexelFit(), 3)) EXPECT_TRUE(std::isnan(f)) << "nothing is known";
}

}  // namespace
}  // namespace lobefit
