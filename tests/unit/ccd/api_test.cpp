#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "ccd/query.h"
#include "contacts.h"
#include "tightrope/ccd.h"

namespace tightrope::ccd {
namespace {

using test::Query;

TEST(Registry, NamesAndMethodsCorrespond) {
  ASSERT_FALSE(methods().empty());
  for (const MethodInfo& info : methods()) {
    EXPECT_EQ(method_by_name(info.name), info.method);
    EXPECT_EQ(name(info.method), info.name);
    EXPECT_FALSE(info.source.empty());
    EXPECT_EQ(info.conservative, info.method != Method::bsc_float);
  }
  EXPECT_EQ(method_by_name("tight"), Method::tight);
  EXPECT_FALSE(method_by_name("Tight").has_value());
  EXPECT_FALSE(method_by_name("").has_value());
  EXPECT_EQ(name(Kind::vertex_face), "vertex-face");
  EXPECT_EQ(name(Kind::edge_edge), "edge-edge");
}

TEST(Api, VertexThroughFaceAndBesideIt) {
  const Eigen::Vector3d a(0, 0, 0), b(1, 0, 0), c(0, 1, 0);
  for (const MethodInfo& info : methods()) {
    EXPECT_TRUE(vertex_face_collides({0.25, 0.25, 1}, a, b, c, {0.25, 0.25, -1}, a, b, c, info.method));
    EXPECT_FALSE(vertex_face_collides({0.75, 0.75, 1}, a, b, c, {0.75, 0.75, -1}, a, b, c, info.method));
    EXPECT_FALSE(vertex_face_collides({0.25, 0.25, 1}, a, b, c, {0.25, 0.25, 0.5}, a, b, c, info.method));
  }
}

TEST(Api, EdgesCrossingAndPassing) {
  const Eigen::Vector3d a(-1, 0, 0), b(1, 0, 0);
  for (const MethodInfo& info : methods()) {
    EXPECT_TRUE(edge_edge_collides(a, b, {0, -1, 1}, {0, 1, 1}, a, b, {0, -1, -1}, {0, 1, -2}, info.method));
    EXPECT_FALSE(edge_edge_collides(a, b, {2, -1, 1}, {2, 1, 1}, a, b, {2, -1, -1}, {2, 1, -2}, info.method));
    EXPECT_FALSE(edge_edge_collides(a, b, {0, -1, 3}, {0, 1, 3}, a, b, {0, -1, 1}, {0, 1, 2}, info.method));
  }
}

TEST(Api, SinglePrecisionAsDouble) {
  const Eigen::Vector3f a(0, 0, 0), b(1, 0, 0), c(0, 1, 0), d(-1, 0, 0);
  for (const MethodInfo& info : methods()) {
    EXPECT_TRUE(vertex_face_collides({0.25F, 0.25F, 1}, a, b, c, {0.25F, 0.25F, -1}, a, b, c, info.method));
    EXPECT_FALSE(vertex_face_collides({0.75F, 0.75F, 1}, a, b, c, {0.75F, 0.75F, -1}, a, b, c, info.method));
    EXPECT_TRUE(edge_edge_collides(d, b, {0, -1, 1}, {0, 1, 1}, d, b, {0, -1, -1}, {0, 1, -2}, info.method));
    EXPECT_FALSE(edge_edge_collides(d, b, {2, -1, 1}, {2, 1, 1}, d, b, {2, -1, -1}, {2, 1, -2}, info.method));
  }
}

template <class Real>
void expect_batch_as_single_queries(Kind kind) {
  test::ContactGenerator contacts(1);
  std::vector<Real> points;
  constexpr std::size_t count = 1000;
  for (std::size_t i = 0; i < count; ++i) {
    const Query query = i % 2 == 0 ? contacts.contact(kind) : test::miss(kind, contacts.random());
    for (const double x : query) points.push_back(static_cast<Real>(x));
  }
  for (const MethodInfo& info : methods()) {
    std::vector<unsigned char> results(count + 1, 7);
    collides(kind, points.data(), count, results.data(), info.method);
    SignCounts signs;
    for (std::size_t i = 0; i < count; ++i) {
      ASSERT_EQ(results[i], collides(kind, points.data() + 24 * i, info.method) ? 1 : 0);
      ASSERT_EQ(results[i], collides(kind, points.data() + 24 * i, info.method, signs) ? 1 : 0);
    }
    EXPECT_EQ(results[count], 7);
    EXPECT_GT(signs.read, count);
    EXPECT_LE(signs.uncertain, signs.read);
  }
}

TEST(Api, BatchAnswersAsSingleQueries) {
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    expect_batch_as_single_queries<double>(kind);
    expect_batch_as_single_queries<float>(kind);
  }
}

}  // namespace
}  // namespace tightrope::ccd
