// The few names of Unity that samples/unity/Palpate.cs uses, and a game that runs it.
using System;
using System.Collections.Generic;
using System.Reflection;
using System.Threading;

namespace UnityEngine
{
    public struct Vector3
    {
        public float x, y, z;
        public Vector3(float x, float y, float z) { this.x = x; this.y = y; this.z = z; }
    }

    public class Mesh
    {
        public Vector3[] vertices, normals;
        public int[]     triangles;
        public int       drawings;
        public void RecalculateNormals() { ++drawings; }
    }

    public class MeshFilter { public Mesh mesh; }

    public class MonoBehaviour
    {
        public MeshFilter filter;
        public T GetComponent<T>() where T : class { return filter as T; }
    }

    public class TooltipAttribute : Attribute { public TooltipAttribute(string text) {} }
    public class RequireComponent : Attribute { public RequireComponent(Type type) {} }
}

static class Game
{
    static int failures;

    static void Expect(bool holds, string what)
    {
        if (!holds) {
            Console.WriteLine("FAILED: " + what);
            ++failures;
        }
    }

    /// A sheet of 61 x 61 vertices in the plane y = 0, 60 mm a side, with its upper side up.
    static UnityEngine.Mesh Sheet(int side)
    {
        var places = new List<UnityEngine.Vector3>();
        var up = new List<UnityEngine.Vector3>();
        var faces = new List<int>();
        for (int i = 0; i < side; ++i)
            for (int j = 0; j < side; ++j) {
                places.Add(new UnityEngine.Vector3(0.06f * i / (side - 1) - 0.03f, 0, 0.06f * j / (side - 1) - 0.03f));
                up.Add(new UnityEngine.Vector3(0, 1, 0));
                int a = side * i + j;
                if (i + 1 < side && j + 1 < side) faces.AddRange(new[] { a, a + 1, a + side + 1, a, a + side + 1, a + side });
            }
        return new UnityEngine.Mesh { vertices = places.ToArray(), normals = up.ToArray(), triangles = faces.ToArray() };
    }

    static PalpateObject Beside(UnityEngine.Mesh mesh)
    {
        return new PalpateObject { filter = new UnityEngine.MeshFilter { mesh = mesh } };
    }

    /// Calls a message of Unity's, as the engine does.
    static void Send(PalpateObject to, string message)
    {
        typeof(PalpateObject).GetMethod(message, BindingFlags.NonPublic | BindingFlags.Instance).Invoke(to, null);
    }

    /// The hand goes down onto the sheet in a second and stays 1 mm deep. Its clock is slower than ours.
    static UnityEngine.Vector3 Pressed(PalpateObject sheet)
    {
        var force = new UnityEngine.Vector3();
        for (int n = 0; n < 2200; ++n) {
            force = sheet.Step(1e-3 * n, new UnityEngine.Vector3(0, Math.Max(-1e-3f, 3e-3f - 4e-6f * n), 0), new UnityEngine.Vector3());
            if (n % 20 == 0) Send(sheet, "Update");
            Thread.Sleep(1);
        }
        return force;
    }

    static int Main()
    {
        UnityEngine.Mesh mesh = Sheet(61);
        PalpateObject sheet = Beside(mesh);
        Send(sheet, "Start");
        UnityEngine.Vector3 force = Pressed(sheet);
        Expect(force.y > 0.2 && force.y < 2, "the sheet pushes back, found " + force.y + " N");
        Expect(Math.Abs(force.x) < 0.02 && Math.Abs(force.z) < 0.02, "along its normal, found " + force.x + ", " + force.z + " N");
        float deepest = 0;
        foreach (UnityEngine.Vector3 v in mesh.vertices) deepest = Math.Min(deepest, v.y);
        Expect(deepest < -1e-4 && deepest > -2e-3, "the mesh bends, found " + deepest + " m");
        Expect(mesh.drawings > 0, "normals follow");
        Expect(sheet.Step(3, new UnityEngine.Vector3(0, float.NaN, 0), new UnityEngine.Vector3()).y == 0, "no force for a hand that is no number");
        Expect(sheet.IsStopped && sheet.Words().Contains("first button"), "its clock has stalled, found: " + sheet.Words());
        for (int n = 0; n < 300; ++n) sheet.Step(3 + 1e-3 * (n + 1), new UnityEngine.Vector3(0, 0.05f, 0), new UnityEngine.Vector3(), 1);
        for (int n = 0; n < 50; ++n) sheet.Step(3.301 + 1e-3 * n, new UnityEngine.Vector3(0, 0.05f, 0), new UnityEngine.Vector3());
        Expect(!sheet.IsStopped, "until its first button is held, found: " + sheet.Words());
        sheet.Step(3.36, new UnityEngine.Vector3(0, 0.05f, 0), new UnityEngine.Vector3(), 0, 0, true);
        Expect(sheet.Words() != "the force comes on" && sheet.Words() != "", "a hand that is absent is said, found: " + sheet.Words());
        Send(sheet, "OnDestroy");
        Expect(sheet.Step(3.4, new UnityEngine.Vector3(0, -1e-3f, 0), new UnityEngine.Vector3()).y == 0, "no force after the end");

        PalpateObject coarse = Beside(Sheet(3)); // touched on points between its vertices, which it cannot draw
        Send(coarse, "Start");
        Send(coarse, "Update");
        Send(coarse, "OnDestroy");

        PalpateObject wrong = Beside(Sheet(61));
        wrong.scene = "{\"thickness\": \"a lot\"}";
        try {
            Send(wrong, "Start");
            Expect(false, "a wrong scene is refused");
        } catch (TargetInvocationException error) {
            Expect(error.InnerException.Message.Contains("thickness"), "with the library's sentence, found: " + error.InnerException.Message);
        }
        Console.WriteLine(failures == 0 ? "the game ran: " + force.y + " N, " + deepest + " m" : failures + " failures");
        return failures == 0 ? 0 : 1;
    }
}
