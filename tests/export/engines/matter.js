// Six balls in each level, added by the loader for matter.js or, as Phaser does it, for Phaser.
const fs = require("fs");
const { pathToFileURL } = require("url");

const { engine: kind, loader, games } = JSON.parse(process.argv[2]);

function phaserMatter() {
  const root = require.resolve("phaser").replace(/([\\/]phaser)[\\/].*$/, "$1"); // its parts are not exported by name
  const lib = `${root}/src/physics/matter-js/lib/`;
  return {
    Engine: require(lib + "core/Engine"),
    Composite: require(lib + "body/Composite"),
    Body: require(lib + "body/Body"),
    Bodies: require(lib + "factory/Bodies"),
    parse: require(`${root}/src/physics/matter-js/PhysicsEditorParser`),
  };
}

function addByPhaser(phaser, world, level, addLevel) {
  const fromPhysicsEditor = (x, y, config, options) => {
    const body = phaser.parse.parseBody(x, y, config, options);
    phaser.Composite.add(world, body);
    return body;
  };
  return addLevel({ matter: { add: { fromPhysicsEditor } } }, level);
}

async function main() {
  const Matter = kind === "phaser" ? phaserMatter() : require("matter-js");
  const { addLevel } = await import(pathToFileURL(loader));
  const results = games.map((game) => {
    const level = JSON.parse(fs.readFileSync(game.file, "utf8"));
    const engine = Matter.Engine.create({ gravity: { x: 0, y: 0 } });
    const added = kind === "phaser" ? addByPhaser(Matter, engine.world, level, addLevel) : addLevel(Matter, engine.world, level);
    const bodies = kind === "phaser" ? (added.parts.length > 1 ? added.parts.slice(1) : added.parts) : added;
    const balls = game.velocities.map(([vx, vy]) => {
      const marks = { restitution: 0, friction: 0, frictionAir: 0, frictionStatic: 0, inertia: Infinity, slop: 0 };
      const ball = Matter.Bodies.circle(game.x, game.y, game.radius, { ...marks, collisionFilter: { group: -1 } });
      Matter.Body.setVelocity(ball, { x: vx, y: vy });
      Matter.Composite.add(engine.world, ball);
      return ball;
    });
    for (let step = 0; step < game.seconds * 60; step++) Matter.Engine.update(engine, 1000 / 60);
    const corners = bodies.flatMap((body) => body.vertices.map((vertex) => [vertex.x, vertex.y]));
    const low = [0, 1].map((axis) => Math.min(...corners.map((corner) => corner[axis])));
    return {
      low,
      area: bodies.reduce((sum, body) => sum + body.area, 0),
      restitution: [...new Set(bodies.map((body) => body.restitution))],
      friction: [...new Set(bodies.map((body) => body.friction))],
      static: bodies.every((body) => body.isStatic || body.parent.isStatic),
      places: balls.map((ball) => [ball.position.x, ball.position.y]),
      speeds: balls.map((ball) => ball.speed),
    };
  });
  console.log(JSON.stringify(results));
}

main();
