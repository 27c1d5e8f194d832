#include <BulletSoftBody/btSoftBody.h>
#include <benchmark/benchmark.h>

// Bullet's soft body on the topology of Lattice: 100 x 100 nodes, springs along the sides and both diagonals,
// one iteration a step.

namespace {

constexpr int side = 100;
constexpr float spacing = 1e-3F;

void soft_body_100x100(benchmark::State& bench) {
  btSoftBodyWorldInfo world;
  world.m_gravity.setZero();
  world.m_sparsesdf.Initialize();
  btSoftBody body(&world);
  body.appendMaterial();
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      body.appendNode(
          btVector3(spacing * static_cast<float>(column), spacing * static_cast<float>(row), 0.0F), 1e-5F);
    }
  }
  const auto node = [](int column, int row) { return row * side + column; };
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      if (column + 1 < side) body.appendLink(node(column, row), node(column + 1, row));
      if (row + 1 < side) body.appendLink(node(column, row), node(column, row + 1));
      if (column + 1 < side && row + 1 < side) {
        body.appendLink(node(column, row), node(column + 1, row + 1));
        body.appendLink(node(column + 1, row), node(column, row + 1));
      }
    }
  }
  body.m_cfg.piterations = 1;
  body.m_cfg.viterations = 0;
  body.m_cfg.diterations = 0;
  body.m_cfg.citerations = 0;
  body.m_cfg.collisions = 0;
  for (auto _ : bench) {
    body.m_nodes[side * side / 2].m_f = btVector3(0.01F, 0.01F, 0.0F);
    body.predictMotion(2.5e-4F);
    body.solveConstraints();
    body.integrateMotion();
  }
  bench.counters["per_node_substep_ns"] = benchmark::Counter(
      side * side * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(soft_body_100x100);

}  // namespace
