// Written by `wallkit export`; the same for every level. Put the JSON of `--format unity` into the project as a text
// asset, add this component to an empty GameObject and drop the asset on `level`. Each wall becomes a child with an
// EdgeCollider2D, which stops from both sides, and its own PhysicsMaterial2D.
using System;
using System.Collections.Generic;
using UnityEngine;

public class WallkitLevel : MonoBehaviour
{
    [Serializable]
    public class Wall
    {
        public string name;
        public string layer;
        public float restitution;
        public float tangentialRestitution;
        public bool closed;
        public bool oneWay;
        public Vector2[] points;
    }

    [Serializable]
    public class Level
    {
        public Wall[] walls;
    }

    public TextAsset level;

    private void Awake()
    {
        foreach (Wall wall in JsonUtility.FromJson<Level>(level.text).walls)
        {
            var child = new GameObject(string.IsNullOrEmpty(wall.name) ? "wall" : wall.name);
            child.transform.SetParent(transform, false);
            var points = new List<Vector2>(wall.points);
            if (wall.closed)
            {
                points.Add(wall.points[0]); // an edge collider does not close itself
            }
            var edges = child.AddComponent<EdgeCollider2D>();
            edges.SetPoints(points);
            edges.sharedMaterial = new PhysicsMaterial2D { friction = 0f, bounciness = wall.restitution };
        }
    }
}
