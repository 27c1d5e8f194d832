// The laws of test::wall, of examples/fuzzy_kelvin_3d.law.toml and examples/friction.law.toml in a scene: says what
// does not hold.
using System;

static class Scene {
  static void Expect(bool holds, string what) {
    if (!holds) Console.WriteLine("does not hold: " + what);
  }

  static bool Is(double[] force, double x, double y, double z) {
    return Math.Abs(force[0] - x) < 1e-9 && Math.Abs(force[1] - y) < 1e-9 && Math.Abs(force[2] - z) < 1e-9;
  }

  static void Wall() {
    using (var law = Kerf.Wall.KerfLaw.Open()) {
      var force = new double[3];
      // 100 N/m from 10 mm on, along the law's z, which is up.
      Expect(law.StepInScene(new[] {0.3, 0.03, 0.4}, new double[3], 1e-3, force) == 0, "a tick is a tick");
      Expect(Is(force, 0, -2, 0), "it pushes back along the vertical");
      Expect(Math.Abs(law.StoredEnergy - 100 * 0.02 * 0.02 / 2) < 1e-12, "a wall holds k d^2 / 2");
      law.Reset();
      Expect(!law.Place(new double[3], new double[3]), "a direction has a length");
      Expect(law.Place(new[] {0, 0, 0.05}, new[] {0, 0, -3.0}), "it is placed");
      law.StepInScene(new[] {0.3, 0.4, 0.04}, new[] {7, 7, -0.5}, 1e-3, force);
      Expect(Is(force, 0, 0, 1 + 1), "it pushes out of the scene");
      law.StepInScene(new[] {0.3, 0.4, 0.04}, null, Kerf.Wall.KerfLaw.None, force);
      Expect(Is(force, 0, 0, 1), "it does without velocity and time");
      Expect(law.StepInScene(new[] {0, 0, double.NaN}, null, 1e-3, force) == Kerf.Wall.KerfLaw.LawFault &&
                 Is(force, 0, 0, 0),
             "a place that is no number is a fault with zero force");
      Expect(law.StepAxes(new double[2], null, 1e-3, new double[2]) == Kerf.Wall.KerfLaw.LawFault,
             "there is one axis");
    }
    try {
      Kerf.Wall.KerfLaw.Open("/nowhere/plugin.so").Dispose();
      Expect(false, "a plug-in that is not there is told");
    } catch (Kerf.Wall.KerfException error) {
      Expect(error.Message == "/nowhere/plugin.so: no such file", error.Message);
    }
  }

  static void Liver() {
    using (var inScene = Kerf.Liver.KerfLaw.Open())
    using (var byAxes = Kerf.Liver.KerfLaw.Open()) {
      var expected = new double[3];
      var force = new double[3];
      double largest = 0;
      for (int tick = 0; tick < 300; ++tick) {
        double x = tick * 1e-5, y = tick * 2e-5, z = tick * -3e-5;
        byAxes.StepAxes(new[] {x, y, z}, new[] {0.01, 0.02, -0.03}, 1e-3, expected);
        inScene.StepInScene(new[] {x, z, y}, new[] {0.01, -0.03, 0.02}, 1e-3, force);
        Expect(force[0] == expected[0] && force[1] == expected[2] && force[2] == expected[1], "y and z change places");
        largest = Math.Max(largest, Math.Abs(force[1]));
      }
      Expect(largest > 0.01, "the tool meets something");
    }
  }

  // Any memory at all, so often, and the collector would have to run.
  static void Memory() {
    using (var law = Kerf.Wall.KerfLaw.Open()) {
      var position = new double[3];
      var force = new double[3];
      double along;
      int before = GC.CollectionCount(0);
      for (int tick = 0; tick < 300000; ++tick) {
        position[1] = 1e-7 * tick;
        law.StepInScene(position, position, 1e-3, force);
        law.Step(position[1], 0, 1e-3, out along);
      }
      Expect(GC.CollectionCount(0) == before, "a step takes no memory");
    }
  }

  static void Hinge() {
    Expect(!Kerf.Hinge.KerfLaw.HasPlaceInScene, "an angle has no place in a scene");
    using (var law = Kerf.Hinge.KerfLaw.Open()) {
      double force;
      Expect(law.Step(0.4, 0, 1e-3, out force) == 0 && force != 0, "it has a step");
      Expect(law.StepInScene(new double[3], null, 1e-3, new double[3]) == Kerf.Hinge.KerfLaw.LawFault, "and no other");
    }
  }

  static int Main() {
    Wall();
    Liver();
    Hinge();
    Memory();
    return 0;
  }
}
