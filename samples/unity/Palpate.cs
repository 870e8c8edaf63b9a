// Palpate in Unity: put PalpateObject beside a MeshFilter, and libpalpate.so into Assets/Plugins. The mesh can be touched
// then: the thread of a haptic device calls Step(), and the mesh bends. README.md says what was run.
using System;
using System.Runtime.InteropServices;
using UnityEngine;

/// The part of palpate.h that a game needs, under the names that it has there.
static class PalpateNative
{
    const string Library = "palpate";

    [StructLayout(LayoutKind.Sequential)]
    public struct Three { public double x, y, z; }

    [StructLayout(LayoutKind.Sequential)]
    public struct palpate_points
    {
        public UIntPtr size, count;
        public IntPtr  positions;
        public int     position_type;
        public UIntPtr position_stride;
        public IntPtr  stiffness;
        public int     stiffness_type;
        public UIntPtr stiffness_stride;
        public int     stiffness_kind;
        public double  uniform_stiffness;
        public IntPtr  normals;
        public int     normal_type;
        public UIntPtr normal_stride;
        public IntPtr  faces;
        public UIntPtr face_count;
        public IntPtr  stiffening;
        public int     stiffening_type;
        public UIntPtr stiffening_stride;
        public IntPtr  foundation;
        public int     foundation_type;
        public UIntPtr foundation_stride;
    }

    [StructLayout(LayoutKind.Sequential)]
    public struct palpate_session_settings
    {
        public UIntPtr size;
        public double  device_mass, device_damping, maximum_force, maximum_stiffness;
    }

    [StructLayout(LayoutKind.Sequential)]
    public struct palpate_hand
    {
        public UIntPtr size;
        public Three   position, velocity;
        public double  age;
        public uint    buttons, absent;
    }

    [StructLayout(LayoutKind.Sequential)]
    public struct palpate_answer
    {
        public UIntPtr size;
        public Three   force;
        public uint    flags, fault;
        public Three   proxy, normal;
        public double  depth, stiffness;
    }

    [DllImport(Library)] public static extern IntPtr palpate_error_text();
    [DllImport(Library)] public static extern int palpate_object_from_points(ref palpate_points points, string scene, out IntPtr made);
    [DllImport(Library)] public static extern UIntPtr palpate_object_size(IntPtr made);
    [DllImport(Library)] public static extern void palpate_object_destroy(IntPtr made);
    [DllImport(Library)] public static extern int palpate_session_create(IntPtr made, ref palpate_session_settings settings, out IntPtr session);
    [DllImport(Library)] public static extern int palpate_session_step(IntPtr session, double time, ref palpate_hand hand, ref palpate_answer answer);
    [DllImport(Library)] public static extern int palpate_session_words(IntPtr session, [Out] byte[] text, UIntPtr size);
    [DllImport(Library)] public static extern int palpate_session_deformed(IntPtr session, [Out] double[] xyz, UIntPtr count, ref ulong sequence);
    [DllImport(Library)] public static extern void palpate_session_destroy(IntPtr session);

    public static UIntPtr SizeOf<Struct>() { return (UIntPtr)Marshal.SizeOf(typeof(Struct)); }

    /// Throws the library's sentence if a call failed.
    public static void Check(int code)
    {
        if (code != 0) throw new InvalidOperationException(Marshal.PtrToStringAnsi(palpate_error_text()));
    }
}

/// A soft mesh. Lengths are metres in the mesh's own frame, so its transform should not scale.
///
/// The engine's formulas hold in Unity's left-handed axes too, because a mesh and the hand on it are mirrored together.
[RequireComponent(typeof(MeshFilter))]
public sealed class PalpateObject : MonoBehaviour
{
    [Tooltip("Young's modulus [Pa]")] public double modulus = 3e5;
    [Tooltip("That the device holds [N]; 0: unknown")] public double maximumForce = 0;
    [Tooltip("Of a wall that the device renders stably at 1 kHz [N/m]; 0: unknown")] public double maximumStiffness = 0;
    [Tooltip("Keys of a scene, as JSON")] public string scene = "{\"thickness\": \"4 mm\", \"foundation\": \"1.74 MPa/m\", \"window\": \"40 mm\"}";

    readonly object gate = new object(); // held by a tick, and by the end
    IntPtr          session;
    volatile bool   stopped;
    Mesh            mesh;
    double[]        bent; // null: the mesh was too coarse to touch, so points on its faces are touched in place of its own
    Vector3[]       drawn;
    ulong           sequence;

    void Start()
    {
        mesh = GetComponent<MeshFilter>().mesh;
        drawn = mesh.vertices;
        IntPtr made = MadeOf(drawn, mesh.normals, mesh.triangles);
        try {
            if ((ulong)PalpateNative.palpate_object_size(made) == (ulong)drawn.Length) bent = new double[3 * drawn.Length];
            var device = new PalpateNative.palpate_session_settings {
                size = PalpateNative.SizeOf<PalpateNative.palpate_session_settings>(),
                maximum_force = maximumForce, maximum_stiffness = maximumStiffness
            };
            PalpateNative.Check(PalpateNative.palpate_session_create(made, ref device, out session));
        } finally {
            PalpateNative.palpate_object_destroy(made);
        }
    }

    IntPtr MadeOf(Vector3[] vertices, Vector3[] normals, int[] triangles)
    {
        GCHandle places = GCHandle.Alloc(vertices, GCHandleType.Pinned), sides = GCHandle.Alloc(normals, GCHandleType.Pinned),
                 faces = GCHandle.Alloc(triangles, GCHandleType.Pinned);
        try {
            const int kFloat32 = 1;
            var points = new PalpateNative.palpate_points {
                size = PalpateNative.SizeOf<PalpateNative.palpate_points>(), count = (UIntPtr)vertices.Length,
                positions = places.AddrOfPinnedObject(), position_type = kFloat32, uniform_stiffness = modulus,
                normals = normals.Length == vertices.Length ? sides.AddrOfPinnedObject() : IntPtr.Zero, normal_type = kFloat32,
                faces = faces.AddrOfPinnedObject(), face_count = (UIntPtr)(triangles.Length / 3)
            };
            IntPtr made;
            PalpateNative.Check(PalpateNative.palpate_object_from_points(ref points, scene, out made));
            return made;
        } finally {
            places.Free();
            sides.Free();
            faces.Free();
        }
    }

    /// Runs one tick and returns the force on the hand [N]: call it a thousand times a second from one thread, the device's.
    /// time [s] rises; position [m] and velocity [m/s] are in the mesh's frame. Allocates nothing.
    /// buttons: bit i for the device's button i; the first one, held for 20 ms, clears a fault of the governor.
    /// age [s] of the position: one that is repeated until a tracker's next grows older, or that next one may count as a jump.
    /// absent: the device has no position now; no force flows.
    public Vector3 Step(double time, Vector3 position, Vector3 velocity, uint buttons = 0, double age = 0, bool absent = false)
    {
        var hand = new PalpateNative.palpate_hand {
            size = PalpateNative.SizeOf<PalpateNative.palpate_hand>(), position = ThreeOf(position), velocity = ThreeOf(velocity),
            buttons = buttons, age = age, absent = absent ? 1u : 0u
        };
        var answer = new PalpateNative.palpate_answer { size = PalpateNative.SizeOf<PalpateNative.palpate_answer>() };
        lock (gate) {
            if (session == IntPtr.Zero) return new Vector3(0, 0, 0);
            PalpateNative.palpate_session_step(session, time, ref hand, ref answer);
        }
        const uint kStopped = 2;
        stopped = (answer.flags & kStopped) != 0;
        return new Vector3((float)answer.force.x, (float)answer.force.y, (float)answer.force.z);
    }

    /// Whether the governor has stopped the force until the first button is held. For any thread.
    public bool IsStopped { get { return stopped; } }

    /// Why the last tick had no force, as a sentence for a person; empty while forces flow. For any thread, but a tick waits.
    public string Words()
    {
        var text = new byte[256];
        lock (gate) {
            if (session == IntPtr.Zero) return "";
            PalpateNative.Check(PalpateNative.palpate_session_words(session, text, (UIntPtr)text.Length));
        }
        return System.Text.Encoding.UTF8.GetString(text).TrimEnd('\0');
    }

    void Update()
    {
        ulong before = sequence;
        if (session == IntPtr.Zero || bent == null) return;
        PalpateNative.Check(PalpateNative.palpate_session_deformed(session, bent, (UIntPtr)drawn.Length, ref sequence));
        if (sequence == before) return;
        for (int n = 0; n < drawn.Length; ++n)
            drawn[n] = new Vector3((float)bent[3 * n], (float)bent[3 * n + 1], (float)bent[3 * n + 2]);
        mesh.vertices = drawn;
        mesh.RecalculateNormals();
    }

    void OnDestroy()
    {
        lock (gate) {
            PalpateNative.palpate_session_destroy(session);
            session = IntPtr.Zero;
        }
    }

    static PalpateNative.Three ThreeOf(Vector3 v) { return new PalpateNative.Three { x = v.x, y = v.y, z = v.z }; }
}
