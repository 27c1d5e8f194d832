// What the exported component needs of Unity, as its documentation has the signatures. Nothing of Unity is in it.
using System;
using System.Globalization;
using System.Reflection;

namespace UnityEngine {

public class Object {}

public struct Vector3 {
  public float x, y, z;
  public Vector3(float x, float y, float z) {
    this.x = x;
    this.y = y;
    this.z = z;
  }
  public static Vector3 zero { get { return new Vector3(0, 0, 0); } }
  public static Vector3 down { get { return new Vector3(0, -1, 0); } }
  public override string ToString() {
    return string.Format(CultureInfo.InvariantCulture, "({0:F1}, {1:F1}, {2:F1})", x, y, z);
  }
}

public class Transform : Object {
  public Vector3 position { get; set; }
}

public class MonoBehaviour : Object {
  readonly Transform at = new Transform();
  public Transform transform { get { return at; } }
  public bool enabled { get; set; }
}

public static class Time {
  public static float fixedDeltaTime { get { return 0.02f; } }
}

public static class Debug {
  public static void LogError(object message, Object context) { Console.WriteLine(message); }
}

[AttributeUsage(AttributeTargets.Field)]
public class TooltipAttribute : Attribute {
  public TooltipAttribute(string tooltip) {}
}

}

static class Program {
  // As Unity calls them, by their names.
  static void Call(object component, string name) {
    component.GetType().GetMethod(name, BindingFlags.Instance | BindingFlags.NonPublic).Invoke(component, null);
  }

  static int Main() {
    var wall = new Kerf.Wall.KerfWall();
    wall.placed = true;
    wall.contact = new UnityEngine.Vector3(0, 0.25f, 0);
    wall.transform.position = new UnityEngine.Vector3(7, 0.23f, 7);
    Call(wall, "OnEnable");
    for (int i = 0; i < 10; ++i) Call(wall, "FixedUpdate");
    Console.WriteLine(wall.Force);
    Call(wall, "OnDisable");

    wall.into = UnityEngine.Vector3.zero;
    Call(wall, "OnEnable");
    return 0;
  }
}
